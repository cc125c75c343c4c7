#pragma once

namespace tress::models {

/// Largest number of quadrature points of an element in kernels for SIMD lanes.
inline constexpr int most_points_of_element = 16;

}  // namespace tress::models
