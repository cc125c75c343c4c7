#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "math/vec3.h"

namespace tress::simulation {

/// Returns the curvature (1/m) of a line at its point i: that of the circle that turns
/// from one chord into the next over half of each. Ends have the curvature of their
/// neighbours; a line of two points has 0. `at(i)`: place of a point.
template <class At>
double line_curvature(const At& at, std::size_t i, std::size_t points) {
  if (points < 3) return 0;
  const std::size_t inner = std::clamp<std::size_t>(i, 1, points - 2);
  const Vec a = at(inner) - at(inner - 1), b = at(inner + 1) - at(inner);
  const double la = norm(a), lb = norm(b);
  const double angle = std::atan2(norm(cross(a, b)), dot(a, b));
  return la + lb > 0 ? 2 * std::tan(angle / 2) / ((la + lb) / 2) : 0;
}

}  // namespace tress::simulation
