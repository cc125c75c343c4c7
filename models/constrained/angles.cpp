#include "models/constrained/angles.h"

#include <algorithm>
#include <numbers>

#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr double least_angle = 1e-3;  // rad; C loses digits like 1/sin(theta0)

/// Derivatives of f = cos of the angle between u and v.
struct Cosine {
  double f;
  double du[3], dv[3];
  double uu[9], uv[9], vv[9];  // d2f / (du dv^T) in uv
};

Cosine cosine_of(Vec u, Vec v) {
  const double lu = norm(u);
  const double lv = norm(v);
  double p[3], q[3];  // unit vectors
  store3((1 / lu) * u, p);
  store3((1 / lv) * v, q);
  Cosine c;
  c.f = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  double pt[3], qt[3];  // q across p, p across q
  for (int i = 0; i < 3; ++i) {
    pt[i] = q[i] - c.f * p[i];
    qt[i] = p[i] - c.f * q[i];
    c.du[i] = pt[i] / lu;
    c.dv[i] = qt[i] / lv;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double one = i == j ? 1 : 0;
      const int k = 3 * i + j;
      c.uu[k] = -(p[i] * pt[j] + pt[i] * p[j] + c.f * (one - p[i] * p[j])) / (lu * lu);
      c.vv[k] = -(q[i] * qt[j] + qt[i] * q[j] + c.f * (one - q[i] * q[j])) / (lv * lv);
      c.uv[k] = (one - q[i] * q[j] - p[i] * qt[j]) / (lu * lv);
    }
  }
  return c;
}

}  // namespace

void Angle::gradient(const double* z, double* g) const {
  const Cosine c = cosine_of(load3(z) - load3(z + 3), load3(z + 6) - load3(z + 3));
  for (int i = 0; i < 3; ++i) {
    g[i] = -c.du[i] / sine;
    g[6 + i] = -c.dv[i] / sine;
    g[3 + i] = -g[i] - g[6 + i];
  }
}

void Angle::hessian(const double* z, const double* w, double* h) const {
  const Cosine c = cosine_of(load3(z) - load3(z + 3), load3(z + 6) - load3(z + 3));
  const double s = -w[0] / sine;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double uu = s * c.uu[3 * i + j];
      const double uv = s * c.uv[3 * i + j];
      const double vu = s * c.uv[3 * j + i];
      const double vv = s * c.vv[3 * i + j];
      h[9 * i + j] = uu;
      h[9 * i + j + 6] = uv;
      h[9 * (i + 6) + j] = vu;
      h[9 * (i + 6) + j + 6] = vv;
      // b enters u and v with a minus sign
      h[9 * i + j + 3] = -uu - uv;
      h[9 * (i + 6) + j + 3] = -vu - vv;
      h[9 * (i + 3) + j] = -uu - vu;
      h[9 * (i + 3) + j + 6] = -uv - vv;
      h[9 * (i + 3) + j + 3] = uu + uv + vu + vv;
    }
  }
}

void Triangle::gradient(const double* z, double* g) const {
  std::fill_n(g, 27, 0.0);
  for (int k = 0; k < 3; ++k) {
    const int a = 3 * k;
    const int b = 3 * ((k + 1) % 3);
    double d[3], edge[3];
    store3(load3(z + a) - load3(z + b), d);
    FixedDistance{length[static_cast<std::size_t>(k)]}.gradient(d, edge);
    for (int i = 0; i < 3; ++i) {
      g[9 * k + a + i] = edge[i];
      g[9 * k + b + i] = -edge[i];
    }
  }
}

void Triangle::hessian(const double*, const double* w, double* h) const {
  std::fill_n(h, 81, 0.0);
  for (int k = 0; k < 3; ++k) {
    const int a = 3 * k;
    const int b = 3 * ((k + 1) % 3);
    const double s = w[k] / length[static_cast<std::size_t>(k)];
    for (int i = 0; i < 3; ++i) {
      h[9 * (a + i) + a + i] += s;
      h[9 * (b + i) + b + i] += s;
      h[9 * (a + i) + b + i] -= s;
      h[9 * (b + i) + a + i] -= s;
    }
  }
}

std::unique_ptr<Constraint> angle(Node a, Node vertex, Node c, double theta) {
  if (!(theta >= least_angle && theta <= std::numbers::pi - least_angle)) {
    throw InputError("angle is too near 0 or pi", "constraint angle",
                     "give an angle between 0.001 and 3.1405 rad, or use distances");
  }
  return std::make_unique<Module<Angle>>(std::array{a, vertex, c},
                                         Angle{std::cos(theta), std::sin(theta)});
}

std::unique_ptr<Constraint> rigid_triangle(Node a, Node b, Node c,
                                           std::array<double, 3> edges) {
  const double total = edges[0] + edges[1] + edges[2];
  for (const double edge : edges) {
    if (!(edge > 0 && 2 * edge < total)) {
      throw InputError("edges do not make a triangle", "constraint rigid_triangle",
                       "give three lengths, each shorter than the other two together");
    }
  }
  return std::make_unique<Module<Triangle>>(std::array{a, b, c}, Triangle{edges});
}

}  // namespace tress::models
