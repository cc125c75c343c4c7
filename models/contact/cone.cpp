#include "models/contact/cone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace tress::models {
namespace {

/// Solves a x = b by the adjugate; a is positive definite.
Vec solve(const Mat3& a, const Vec& b) {
  const Vec c0 = cross(a.r1, a.r2), c1 = cross(a.r2, a.r0), c2 = cross(a.r0, a.r1);
  return (1 / dot(a.r0, c0)) * (b.x * c0 + b.y * c1 + b.z * c2);
}

/// A direction in the tangent plane, of length 1.
struct Direction {
  double c, s;
};
Direction direction(double c, double s) {
  const double inverse = 1 / std::sqrt(c * c + s * s);
  return {inverse * c, inverse * s};
}
// Up to this a^2 the length sqrt(1 + a^2) is 1 + a^2/2 to rounding.
constexpr double small_square = 1e-8;
/// Turned by an angle, to first order in it.
Direction turned(const Direction& e, double angle) {
  const double c = e.c - angle * e.s, s = e.s + angle * e.c, square = angle * angle;
  if (square > small_square) return direction(c, s);
  const double inverse = 1 - 0.5 * square;
  return {inverse * c, inverse * s};
}

/// Sliding with u_t along a direction e.
class Slide {
 public:
  Slide(const Mat3& w, const Vec& b, double mu) : w_(w), b_(b), mu_(mu) {}

  struct At {
    double share;   // W_nn - mu W_nt e: u_n per r_n
    double across;  // u_t across e, times share; 0 where the law holds
    double slope;   // of `across` by the angle
  };
  At at(const Direction& e) const {
    const double c = e.c, s = e.s;
    // Along e and across it, (-s, c).
    const double nt_e = w_.r0.y * c + w_.r0.z * s, nt_f = w_.r0.z * c - w_.r0.y * s;
    const double tn_f = w_.r2.x * c - w_.r1.x * s, tn_e = w_.r1.x * c + w_.r2.x * s;
    const double b_f = b_.z * c - b_.y * s, b_e = b_.y * c + b_.z * s;
    const double fe = c * s * (w_.r2.z - w_.r1.y) + w_.r2.y * c * c - w_.r1.z * s * s;
    const double by_angle =
        (w_.r2.z - w_.r1.y) * (c * c - s * s) - 2 * (w_.r2.y + w_.r1.z) * c * s;
    const double share = w_.r0.x - mu_ * nt_e;
    return {share, share * b_f - b_.x * (tn_f - mu_ * fe),
            -mu_ * nt_f * b_f - share * b_e + b_.x * (tn_e + mu_ * by_angle)};
  }
  double share(const Direction& e) const {
    return w_.r0.x - mu_ * (w_.r0.y * e.c + w_.r0.z * e.s);
  }
  /// The force there; empty if it pushes along the motion.
  std::optional<Vec> force(const Direction& e) const {
    const double share = this->share(e);
    if (!(share > 0)) return {};
    const double normal = -b_.x / share;
    const Vec r{normal, -mu_ * normal * e.c, -mu_ * normal * e.s};
    const double u_y = dot(w_.r1, r) + b_.y, u_z = dot(w_.r2, r) + b_.z;
    if (!(u_y * e.c + u_z * e.s >= 0)) return {};
    return r;
  }

 private:
  const Mat3& w_;
  const Vec& b_;
  double mu_;
};

// Of W_nn, the least response that a force without a law is computed with.
constexpr double least_share = 0.1;

constexpr int newton_iterations = 12, searched = 48, halvings = 50;
// Newton's steps are squared each time: the one after this is 1e-8, and those who solve
// many contacts come back to each with its last force as a guess.
constexpr double last_step = 1e-4;

std::optional<Vec> by_newton(const Slide& slide, Direction e) {
  for (int i = 0; i < newton_iterations; ++i) {
    const Slide::At p = slide.at(e);
    const double step = p.across / p.slope;
    if (!(std::abs(step) < 1)) return {};
    e = turned(e, -step);
    if (std::abs(step) < last_step) return slide.force(e);
  }
  return {};
}

const std::array<Direction, searched + 1>& all_directions() {
  static const auto all = [] {
    std::array<Direction, searched + 1> made{};
    for (int i = 0; i <= searched; ++i) {
      const double angle = i * 2 * std::numbers::pi / searched;
      made[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return made;
  }();
  return all;
}

/// The root in each part of the circle in which `across` changes sign.
std::optional<Vec> by_search(const Slide& slide) {
  const auto& all = all_directions();
  for (std::size_t i = 0; i < searched; ++i) {
    Direction from = all[i], to = all[i + 1];
    const bool rises = slide.at(from).across < 0;
    if (rises == (slide.at(to).across < 0)) continue;
    for (int k = 0; k < halvings; ++k) {
      const Direction middle = direction(from.c + to.c, from.s + to.s);
      ((slide.at(middle).across < 0) == rises ? from : to) = middle;
    }
    if (const auto r = slide.force(from)) return r;
  }
  return {};
}

}  // namespace

Vec contact_force(const Mat3& w, const Vec& b, double mu, const Vec& guess) {
  if (b.x >= 0) return {};
  if (mu == 0) return {-b.x / w.r0.x, 0, 0};
  const Vec sticks = -1.0 * solve(w, b);
  const double pull = sticks.y * sticks.y + sticks.z * sticks.z, most = mu * sticks.x;
  if (sticks.x >= 0 && pull <= most * most) return sticks;
  const Slide slide(w, b, mu);
  if (guess.y != 0 || guess.z != 0) {
    if (const auto r = by_newton(slide, direction(-guess.y, -guess.z))) return *r;
  }
  const Direction start = direction(-sticks.y, -sticks.z);
  if (const auto r = by_newton(slide, start)) return *r;
  if (const auto r = by_search(slide)) return *r;
  const double normal = -b.x / std::max(slide.share(start), least_share * w.r0.x);
  return {normal, -mu * normal * start.c, -mu * normal * start.s};
}

double contact_violation(const Mat3& w, const Vec& u, const Vec& r, double mu) {
  if (u.x >= 0 && r.x == 0 && r.y == 0 && r.z == 0) return 0;
  const double m = trace(w) / 3;
  if (mu == 0) {
    const double normal = std::abs(m * r.x + u.x - std::hypot(m * r.x, u.x));
    return std::max(normal, m * std::hypot(r.y, r.z));
  }
  const double x0 = m * mu * r.x, x1 = m * r.y, x2 = m * r.z;
  const double y0 = u.x / mu + std::sqrt(u.y * u.y + u.z * u.z), y1 = u.y, y2 = u.z;
  // The square root of x^2 + y^2 in the algebra of the cone.
  const double s0 = x0 * x0 + x1 * x1 + x2 * x2 + y0 * y0 + y1 * y1 + y2 * y2;
  const double s1 = 2 * (x0 * x1 + y0 * y1), s2 = 2 * (x0 * x2 + y0 * y2);
  const double size = std::sqrt(s1 * s1 + s2 * s2);
  const double more = std::sqrt(s0 + size), less = std::sqrt(std::max(0.0, s0 - size));
  const double along = size > 0 ? 0.5 * (more - less) / size : 0;
  const Vec phi{x0 + y0 - 0.5 * (more + less), x1 + y1 - along * s1,
                x2 + y2 - along * s2};
  return norm(phi);
}

}  // namespace tress::models
