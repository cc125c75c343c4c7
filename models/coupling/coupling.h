#pragma once

#include <array>
#include <cstddef>

#include "contract/layers.h"
#include "math/vec3.h"

namespace tress::models {

/// Derivatives of the loads of one contact on its four points with respect to the
/// positions and velocities of all four,
///
///     df_a = sum_r onto_ar y_r
///     y_r = sum_c by_place_cr . dx_c + by_velocity_cr . dv_c
///
/// in world components, N/m and N s/m between f and x, v. The rank is four: the points
/// share one force and its point of application.
struct Coupling {
  static constexpr std::size_t rank = 4;  // number of terms y_r
  /// Factors of one point.
  struct End {
    std::size_t point = 0;                              // index of the point
    std::array<Vec, rank> onto, by_place, by_velocity;  // factors of each term
  };
  std::array<End, 4> ends;  // the four points

  /// block += pos df_a/dx_c + vel df_a/dv_c, row-major 3x3.
  void add_block(std::size_t a, std::size_t c, double pos, double vel,
                 double* block) const {
    for (std::size_t r = 0; r < rank; ++r) {
      const Vec row = pos * ends[c].by_place[r] + vel * ends[c].by_velocity[r];
      const Vec& onto = ends[a].onto[r];
      const double along[] = {onto.x, onto.y, onto.z};
      for (std::size_t k = 0; k < 3; ++k) {
        store3(load3(block + 3 * k) + along[k] * row, block + 3 * k);
      }
    }
  }
};

}  // namespace tress::models
