#include "models/splines/cubic_spline.h"

#include <algorithm>
#include <stdexcept>

#include "math/banded_lu.h"

namespace tress::models {

CubicSpline::CubicSpline(const std::vector<double>& spans) : knots_{0} {
  for (const double span : spans) knots_.push_back(knots_.back() + span);
}

/// Recursion of Cox and de Boor; the derivative of degree d comes from values of degree d
/// - 1.
CubicSpline::Basis CubicSpline::at(std::size_t span, double along) const {
  const auto last = static_cast<std::ptrdiff_t>(spans());
  const auto knot = [&](std::ptrdiff_t offset) {
    const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(span) + offset;
    return knots_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
  };
  const double s = knot(0) + along;
  // of[d][k]: function k of the d + 1 of degree d that live on the span; it starts at
  // knot(k - d) and ends at knot(k + 1).
  double of[4][4] = {{1}};
  for (std::ptrdiff_t d = 1; d <= 3; ++d) {
    for (std::ptrdiff_t k = 0; k <= d; ++k) {
      double sum = 0;
      if (k > 0) sum += (s - knot(k - d)) / (knot(k) - knot(k - d)) * of[d - 1][k - 1];
      if (k < d) {
        sum += (knot(k + 1) - s) / (knot(k + 1) - knot(k + 1 - d)) * of[d - 1][k];
      }
      of[d][k] = sum;
    }
  }
  // Slope of function k of degree d, from values (or slopes) of degree d - 1.
  const auto slope = [&](const double* lower, std::ptrdiff_t d, std::ptrdiff_t k) {
    double sum = 0;
    const auto degree = static_cast<double>(d);
    if (k > 0) sum += degree / (knot(k) - knot(k - d)) * lower[k - 1];
    if (k < d) sum -= degree / (knot(k + 1) - knot(k + 1 - d)) * lower[k];
    return sum;
  };
  double quadratic_slope[3];
  for (std::ptrdiff_t k = 0; k <= 2; ++k) quadratic_slope[k] = slope(of[1], 2, k);
  Basis basis;
  for (std::ptrdiff_t k = 0; k <= 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    basis.value[i] = of[3][k];
    basis.first[i] = slope(of[2], 3, k);
    basis.second[i] = slope(quadratic_slope, 3, k);
  }
  return basis;
}

std::vector<Vec> CubicSpline::through(const std::vector<StrandPlace>& places) const {
  const std::size_t n = spans(), size = controls();
  // Row i has entries at i - 3 .. i + 3: functions of the span before it, or at the ends.
  constexpr int reach = 3;
  BandedLu matrix(static_cast<int>(size), reach, reach);
  matrix.clear();
  std::vector<double> right[3];
  const auto condition = [&](std::size_t first, const std::array<double, 4>& weight,
                             const Vec& value) {
    const auto row = static_cast<int>(right[0].size());
    for (int k = 0; k < 4; ++k) {
      matrix.at(row, static_cast<int>(first) + k) = weight[static_cast<std::size_t>(k)];
    }
    right[0].push_back(value.x);
    right[1].push_back(value.y);
    right[2].push_back(value.z);
  };
  condition(0, at(0, 0).first, places.front().frame.e0);
  for (std::size_t i = 0; i < n; ++i) condition(i, at(i, 0).value, places[i].x);
  const Basis end = at(n - 1, length(n - 1));
  condition(n - 1, end.value, places.back().x);
  condition(n - 1, end.first, places.back().frame.e0);
  if (!matrix.factor()) throw std::runtime_error("the spline's conditions are singular");
  for (std::vector<double>& x : right) matrix.solve(x);
  std::vector<Vec> points;
  for (std::size_t k = 0; k < size; ++k) {
    points.push_back({right[0][k], right[1][k], right[2][k]});
  }
  return points;
}

}  // namespace tress::models
