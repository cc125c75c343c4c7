#pragma once

#include <array>
#include <cmath>

#include "math/lagrange.h"
#include "models/effects/effect.h"

namespace tress::models {

/// Shares w_k of a place on a strand among its points from `first` on. A quantity at the
/// place is the sum of w_k times that of up to four neighbouring points: the polynomial
/// through them. At the tip this is exact for nodes, cubic splines and rigid links, and
/// of fourth order in the element for helices and clothoids.
struct PlaceShares {
  std::size_t first = 0;           // index of the first point
  std::size_t count = 0;           // number of points
  std::array<double, 4> weight{};  // w_k of the points

  /// Returns the sum of w_k values_k, three numbers each.
  Vec mean(In values) const noexcept {
    Vec sum;
    for (std::size_t k = 0; k < count; ++k) {
      sum = sum + weight[k] * load3(&values[3 * (first + k)]);
    }
    return sum;
  }
};

/// Returns the shares of the place at `at` times the arc length of the tip. Reads the arc
/// lengths of the points. O(points).
inline PlaceShares shares_of_place(const Points& p, double at) noexcept {
  // A place nearer to a point than this part of the length is that point.
  constexpr double same_place = 1e-9;
  const double s = at * p.longest;
  const auto away = [&](std::size_t i) { return std::abs(p.arc[i] - s); };
  PlaceShares all;
  for (std::size_t i = 1; i < p.arc.size(); ++i) {
    // Points that only fill a pack carry no length.
    if (p.length[i] > 0 && away(i) < away(all.first)) all.first = i;
  }
  std::size_t end = all.first + 1;
  if (away(all.first) > same_place * p.longest) {
    const auto joins = [&](std::size_t i, std::size_t j) {
      return p.length[i] > 0 && p.length[j] > 0 && p.arc[i] < p.arc[j];
    };
    while (end - all.first < all.weight.size()) {
      const bool before = all.first > 0 && joins(all.first - 1, all.first),
                 after = end < p.arc.size() && joins(end - 1, end);
      if (!before && !after) break;
      if (before && (!after || away(all.first - 1) <= away(end))) {
        --all.first;
      } else {
        ++end;
      }
    }
  }
  all.count = end - all.first;
  for (std::size_t k = 0; k < all.count; ++k) {
    all.weight[k] =
        lagrange(k, all.count, s, [&](std::size_t n) { return p.arc[all.first + n]; });
  }
  return all;
}

}  // namespace tress::models
