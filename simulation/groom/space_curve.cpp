#include "simulation/groom/space_curve.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace tress::simulation {

/// Computes second derivatives at the knots of a cubic spline. The inner ones satisfy
///
///     h0 m0 + 2 (h0 + h1) m1 + h1 m2 = 6 (d1 - d0)
///
/// with h the distances of knots and d the slopes of chords before and after. At an end
/// m0 = m1 + r (m1 - m2), r = h0/h1, by which the third derivative passes the knot next
/// to it. A last piece longer than twice the one before takes r = 2: noise in m1 - m2
/// would grow with r. O(n).
void SpaceCurve::interpolate(std::span<const Vec> points) {
  places_.assign(points.begin(), points.end());
  const std::size_t n = points.size();
  bends_.assign(n, {});
  if (n < 3) return;
  const auto h = [this](std::size_t i) { return knots_[i + 1] - knots_[i]; };
  const auto slope = [&](std::size_t i) {
    return 1 / h(i) * (points[i + 1] - points[i]);
  };
  if (n == 3) {
    std::ranges::fill(bends_, 2 / (h(0) + h(1)) * (slope(1) - slope(0)));
    return;
  }
  constexpr double farthest = 2;
  const double first = std::min(h(0) / h(1), farthest);
  const double last = std::min(h(n - 2) / h(n - 3), farthest);
  // Thomas' algorithm for the inner knots; the end rows lose m0 and m_{n-1}.
  std::vector<double> upper(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    double below = h(i - 1), diagonal = 2 * (h(i - 1) + h(i)), above = h(i);
    if (i == 1) {
      diagonal += (1 + first) * below;
      above -= first * below;
      below = 0;
    }
    if (i + 2 == n) {
      diagonal += (1 + last) * h(i);
      below -= last * h(i);
      above = 0;
    }
    const double pivot = diagonal - below * upper[i - 1];
    upper[i] = above / pivot;
    bends_[i] = 1 / pivot * (6.0 * (slope(i) - slope(i - 1)) - below * bends_[i - 1]);
  }
  for (std::size_t i = n - 2; i-- > 1;) bends_[i] = bends_[i] - upper[i] * bends_[i + 1];
  bends_[0] = bends_[1] + first * (bends_[1] - bends_[2]);
  bends_[n - 1] = bends_[n - 2] + last * (bends_[n - 2] - bends_[n - 3]);
}

SpaceCurve::SpaceCurve(std::span<const Vec> points, int fine, const std::string& where)
    : fine_(fine) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    knots_.push_back(i == 0 ? 0 : knots_.back() + norm(points[i] - points[i - 1]));
    if (i > 0 && !(knots_[i] - knots_[i - 1] >= least_step)) {
      throw InputError("points " + std::to_string(i) + " and " + std::to_string(i + 1) +
                           " are less than 1 nm apart",
                       where, "leave one of them out");
    }
  }
  interpolate(points);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (int j = 0; j < fine; ++j) {
      u_.push_back(std::lerp(knots_[i], knots_[i + 1], static_cast<double>(j) / fine));
    }
  }
  u_.push_back(knots_.back());
  arc_.push_back(0);
  double before = norm(rate(u_[0]));
  for (std::size_t i = 1; i < u_.size(); ++i) {
    const double middle = norm(rate((u_[i - 1] + u_[i]) / 2)), after = norm(rate(u_[i]));
    arc_.push_back(arc_.back() + (u_[i] - u_[i - 1]) * (before + after + 4 * middle) / 6);
    before = after;
  }
}

double SpaceCurve::parameter(double s) const {
  const auto after =
      std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(arc_, s) - arc_.begin(), 1,
                                 static_cast<std::ptrdiff_t>(arc_.size()) - 1);
  const auto j = static_cast<std::size_t>(after), i = j - 1;
  return std::lerp(u_[i], u_[j], (s - arc_[i]) / (arc_[j] - arc_[i]));
}

SpaceCurve::Piece SpaceCurve::piece(double u) const {
  const std::ptrdiff_t inner = std::ranges::upper_bound(knots_, u) - knots_.begin() - 1;
  const auto most = static_cast<std::ptrdiff_t>(knots_.size()) - 2;
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(inner, 0, most));
  const double h = knots_[i + 1] - knots_[i];
  return {i, h, std::clamp((u - knots_[i]) / h, 0.0, 1.0)};
}

Vec SpaceCurve::position(double u) const {
  const auto [i, h, t] = piece(u);
  const double s = 1 - t, w = h * h / 6;
  return s * places_[i] + t * places_[i + 1] + w * (s * s * s - s) * bends_[i] +
         w * (t * t * t - t) * bends_[i + 1];
}
Vec SpaceCurve::rate(double u) const {
  const auto [i, h, t] = piece(u);
  const double s = 1 - t, w = h / 6;
  return 1 / h * (places_[i + 1] - places_[i]) + w * (1 - 3 * s * s) * bends_[i] +
         w * (3 * t * t - 1) * bends_[i + 1];
}
Vec SpaceCurve::tangent(double u) const {
  const Vec r = rate(u);
  const double size = norm(r);
  if (size > 0) return 1 / size * r;
  // A fold: any direction of the points nearby.
  const double near = 1e-3 * knots_.back();
  const Vec chord = position(u + near) - position(u - near);
  return norm(chord) > 0 ? 1 / norm(chord) * chord : Vec{1, 0, 0};
}

}  // namespace tress::simulation
