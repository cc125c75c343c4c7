#pragma once

#include <array>

#include "contract/forms/material_points.h"
#include "math/vec3.h"

namespace tress::models {

/// b += J^T force, with J = du/dv of a material point. Returns false if the model does
/// not compute it.
inline bool add_point_force(MaterialPoints& points, double t, In q, int point,
                            const Vec& force, InOut b) {
  const std::array<double, 3> f{force.x, force.y, force.z};
  const auto mean = points.mean(point);
  if (!mean) return points.pull_back(t, q, {&point, 1}, f, b);
  for (std::size_t k = 0; k < static_cast<std::size_t>(mean->count); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      b[static_cast<std::size_t>(mean->coordinate[k]) + c] += mean->weight[k] * f[c];
    }
  }
  return true;
}

}  // namespace tress::models
