#include "models/contact/body_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tress::models {
namespace {

/// The distance from a point, and upwards at the point itself.
Distance from_point(const Vec& arm, double radius) {
  const double r = norm(arm);
  return {r - radius, r > 0 ? (1 / r) * arm : Vec{0, 0, 1}};
}

Mat3 curvature_around_point(const Vec& arm) {
  const double square = dot(arm, arm);
  if (square == 0) return {};
  const double r = std::sqrt(square);
  return (1 / r) * (identity() - (1 / square) * outer(arm, arm));
}

/// From the nearest point of the axis of a capsule.
Vec arm_of(const Capsule& capsule, const Vec& x) {
  return {x.x, x.y, x.z - std::clamp(x.z, -capsule.half_length, capsule.half_length)};
}

}  // namespace

Distance Sphere::distance(const Vec& x) const { return from_point(x, radius); }
Mat3 Sphere::curvature(const Vec& x) const { return curvature_around_point(x); }

Distance Capsule::distance(const Vec& x) const {
  const Vec arm = arm_of(*this, x);
  const bool on_axis = arm.x == 0 && arm.y == 0 && arm.z == 0;
  return on_axis ? Distance{-radius, {1, 0, 0}} : from_point(arm, radius);
}

Mat3 Capsule::curvature(const Vec& x) const {
  const Vec arm = arm_of(*this, x);
  const Mat3 all = curvature_around_point(arm);
  if (std::abs(x.z) > half_length) return all;
  return {{all.r0.x, all.r0.y, 0}, {all.r1.x, all.r1.y, 0}, {}};  // none along the axis
}

Ellipsoid::Nearest Ellipsoid::nearest(const Vec& x) const {
  const std::array a{a_.x, a_.y, a_.z}, at{x.x, x.y, x.z};
  const auto least =
      static_cast<std::size_t>(std::min_element(a.begin(), a.end()) - a.begin());
  const double shift = a[least] * a[least];
  // s = tau + shift >= 0, so that points near the middle plane lose no digits.
  std::array<double, 3> above;  // a_i^2 - shift >= 0
  double s = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    above[i] = (a[i] - a[least]) * (a[i] + a[least]);
    s = std::max(s, a[i] * std::abs(at[i]) - above[i]);
  }
  double g = 0;
  constexpr int most_steps = 100;  // some 10 are enough; the limit is for NaN
  for (int step = 0; step < most_steps; ++step) {
    double slope = 0;
    g = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      if (at[i] == 0) continue;
      const double ratio = a[i] * at[i] / (s + above[i]);
      g += ratio * ratio;
      slope -= 2 * ratio * ratio / (s + above[i]);
    }
    const double next = g > 0 ? s - g / slope : s;
    if (!(next > s)) break;
    s = next;
  }
  std::array<double, 3> normal;  // y_i/a_i^2
  for (std::size_t i = 0; i < 3; ++i) {
    normal[i] = at[i] == 0 ? 0 : at[i] / (s + above[i]);
  }
  // On the middle plane near the centre no root is right of the pole: the nearest points
  // are above and below.
  if (s == 0) normal[least] = std::sqrt(std::max(0.0, -g)) / a[least];
  const Vec n{normal[0], normal[1], normal[2]};
  const double length = norm(n);
  return {(s - shift) * length, (1 / length) * n, length};
}

double Ellipsoid::at_least(const Vec& x) const {
  const Vec scaled{x.x / a_.x, x.y / a_.y, x.z / a_.z};
  return std::min({a_.x, a_.y, a_.z}) * (norm(scaled) - 1);
}

Distance Ellipsoid::distance(const Vec& x) const {
  const Nearest y = nearest(x);
  return {y.phi, y.normal};
}

Mat3 Ellipsoid::curvature(const Vec& x) const {
  const Nearest y = nearest(x);
  const Mat3 across = identity() - outer(y.normal, y.normal);
  const Mat3 axes = diagonal({1 / (a_.x * a_.x), 1 / (a_.y * a_.y), 1 / (a_.z * a_.z)});
  const Mat3 shape = (1 / y.length) * (across * axes * across);
  // S (1 + phi S)^-1 in the tangent plane by Cayley and Hamilton; the denominator is 0 on
  // focal lines, where the derivative does not exist.
  const double mean = trace(shape);
  const double gauss = (mean * mean - trace(shape * shape)) / 2;
  const double denominator = std::max(1 + y.phi * mean + y.phi * y.phi * gauss, 1e-12);
  return (1 / denominator) * (shape + (y.phi * gauss) * across);
}

}  // namespace tress::models
