#include "models/contact/body_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tress::models {

Ellipsoid::Ellipsoid(const Vec& half_axes)
    : a_(half_axes),
      inverse_{1 / a_.x, 1 / a_.y, 1 / a_.z},
      least_(std::min({a_.x, a_.y, a_.z})),
      above_{(a_.x - least_) * (a_.x + least_), (a_.y - least_) * (a_.y + least_),
             (a_.z - least_) * (a_.z + least_)} {}

NearestOf<double> Ellipsoid::nearest(const Vec& x) const {
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
  return {{(s - shift) * length, (1 / length) * n}, length};
}

}  // namespace tress::models
