#pragma once

#include "contract/layers.h"
#include "math/frame.h"
#include "math/lanes.h"

namespace tress::models {

/// A 3x3 matrix for each of four points, in the components of a segment's start.
struct PointMatrix {
  PointMatrix() = default;
  /// Takes row-major matrices (9 per point) in world components; f is the frame of the
  /// start.
  PointMatrix(const double* matrices, const Frame& f) {
    const Vec3<Pack> axes[3] = {Vec3<Pack>(f.e0), Vec3<Pack>(f.e1), Vec3<Pack>(f.e2)};
    Vec3<Pack> rows[3];  // in world components
    for (std::size_t r = 0; r < 3; ++r) {
      rows[r] = gather3(matrices + 3 * r, 9);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3<Pack> world{dot(rows[0], axes[c]), dot(rows[1], axes[c]),
                             dot(rows[2], axes[c])};
      column[c] = {dot(axes[0], world), dot(axes[1], world), dot(axes[2], world)};
    }
  }

  /// Returns the products with the vector x of each point.
  Vec3<Pack> operator*(const Vec3<Pack>& x) const {
    return x.x * column[0] + x.y * column[1] + x.z * column[2];
  }

  /// Returns the products of the transposed matrices with the vector x of each point.
  Vec3<Pack> back(const Vec3<Pack>& x) const {
    return {dot(column[0], x), dot(column[1], x), dot(column[2], x)};
  }

  Vec3<Pack> column[3];  // columns of the four matrices
};

/// Returns entry (0, 0) of four matrices (9 numbers each).
inline Pack first_entries(const double* matrices) { return gather3(matrices, 9).x; }

/// Whether a matrix is a number times the unit matrix, as of drag. False for a matrix
/// that is not finite.
inline bool is_multiple_of_unit(const double* m) {
  return m[4] == m[0] && m[8] == m[0] && m[1] == 0 && m[2] == 0 && m[3] == 0 &&
         m[5] == 0 && m[6] == 0 && m[7] == 0;
}

}  // namespace tress::models
