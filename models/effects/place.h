#pragma once

#include <array>

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
  Vec mean(In values) const noexcept;
};

/// Returns the shares of the place at `at` times the arc length of the tip. Reads the arc
/// lengths of the points. O(points).
PlaceShares shares_of_place(const Points& p, double at) noexcept;

}  // namespace tress::models
