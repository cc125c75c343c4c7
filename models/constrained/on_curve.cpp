#include "models/constrained/on_curve.h"

#include <algorithm>

#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr double alignment = 1e-9;  // relative error of a frame given by the caller

/// Unit axes along a, b and a x b. Throws unless a and b are orthogonal and not zero.
std::array<Vec, 3> frame(Vec a, Vec b, const char* who) {
  const double size = norm(a) * norm(b);
  if (!(std::abs(dot(a, b)) <= alignment * size) || size == 0 || !std::isfinite(size)) {
    throw InputError("semi-axes are not orthogonal, zero or not finite", who,
                     "give two orthogonal vectors in m");
  }
  const Vec e1 = (1 / norm(a)) * a;
  const Vec e2 = (1 / norm(b)) * b;
  return {e1, e2, cross(e1, e2)};
}

/// h = s a a^T + t b b^T
void outer_sum(double s, Vec a, double t, Vec b, double* h) {
  const double p[3] = {a.x, a.y, a.z};
  const double q[3] = {b.x, b.y, b.z};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) h[3 * i + j] = s * p[i] * p[j] + t * q[i] * q[j];
  }
}

}  // namespace

void OnEllipse::gradient(const double* d, double* g) const {
  const double size = std::sqrt(a * b);
  const double s1 = size / (a * a) * dot(e1, load3(d));
  const double s2 = size / (b * b) * dot(e2, load3(d));
  store3(s1 * e1 + s2 * e2, g);
  store3(e3, g + 3);
}

void OnEllipse::hessian(const double*, const double* w, double* h) const {
  const double size = w[0] * std::sqrt(a * b);
  outer_sum(size / (a * a), e1, size / (b * b), e2, h);
}

void OnHelix::gradient(const double* d, double* g) const {
  const double w = dot(e3, load3(d)) / rise;
  store3(e1 + (radius / rise * std::sin(w)) * e3, g);
  store3(e2 - (radius / rise * std::cos(w)) * e3, g + 3);
}

void OnHelix::hessian(const double* d, const double* w, double* h) const {
  const double angle = dot(e3, load3(d)) / rise;
  const double bend = radius / (rise * rise);
  outer_sum(bend * (w[0] * std::cos(angle) + w[1] * std::sin(angle)), e3, 0, {}, h);
}

void OnCurve::value(const double* z, double* c) const {
  store3(load3(z) - curve->at(z[3]).c, c);
}

void OnCurve::gradient(const double* z, double* g) const {
  const CurvePoint p = curve->at(z[3]);
  const double slope[3] = {p.d1.x, p.d1.y, p.d1.z};
  std::fill_n(g, 12, 0.0);
  for (int k = 0; k < 3; ++k) {
    g[4 * k + k] = 1;
    g[4 * k + 3] = -slope[k];
  }
}

void OnCurve::hessian(const double* z, const double* w, double* h) const {
  std::fill_n(h, 16, 0.0);
  h[15] = -dot(load3(w), curve->at(z[3]).d2);
}

std::unique_ptr<Constraint> point_on_ellipse(Node x, Node centre, Vec a, Vec b) {
  const auto [e1, e2, e3] = frame(a, b, "constraint point_on_ellipse");
  using Kernel = Difference<OnEllipse>;
  return std::make_unique<Module<Kernel>>(std::array{x, centre},
                                          Kernel{{e1, e2, e3, norm(a), norm(b)}});
}

std::unique_ptr<Constraint> point_on_helix(Node x, Node centre, Vec a, Vec b, Vec rise) {
  const auto [e1, e2, e3] = frame(a, b, "constraint point_on_helix");
  const double along = dot(rise, e3);
  if (std::abs(norm(a) - norm(b)) > alignment * norm(a) || along == 0 ||
      !(norm(rise - along * e3) <= alignment * std::abs(along))) {
    throw InputError("helix is not round, has no rise or is oblique",
                     "constraint point_on_helix", "give |a| = |b| and rise along a x b");
  }
  using Kernel = Difference<OnHelix>;
  return std::make_unique<Module<Kernel>>(std::array{x, centre},
                                          Kernel{{e1, e2, e3, norm(a), along}});
}

std::unique_ptr<Constraint> point_on_curve(Node x, Node parameter,
                                           std::shared_ptr<const Curve> curve) {
  if (parameter.kind != Node::Kind::parameter || x.kind == Node::Kind::parameter) {
    throw InputError("nodes are not a point and a parameter", "constraint point_on_curve",
                     "make the second one with add_parameter");
  }
  return std::make_unique<Module<OnCurve>>(std::array{x, parameter},
                                           OnCurve{std::move(curve)});
}

}  // namespace tress::models
