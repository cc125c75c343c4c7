#pragma once

#include "models/math/frame.h"
#include "models/math/pack.h"
#include "models/system.h"

namespace tress {

/// A 3x3 matrix of each of four points, in the components of a segment's start.
struct PointMatrix {
  PointMatrix() = default;
  /// Of block b of row-major matrices (9 a point) in world components; f: of the start.
  PointMatrix(In matrices, std::size_t b, const Frame& f) {
    const Vec3<Pack> axes[3] = {Vec3<Pack>(f.e0), Vec3<Pack>(f.e1), Vec3<Pack>(f.e2)};
    Vec3<Pack> rows[3];  // in world components
    for (std::size_t r = 0; r < 3; ++r) {
      Pack entry[3];
      for (std::size_t c = 0; c < 3; ++c) {
        const double* p = &matrices[9 * Pack::lanes * b + 3 * r + c];
        entry[c] = Pack(Pack::Vector{p[0], p[9], p[18], p[27]});
      }
      rows[r] = {entry[0], entry[1], entry[2]};
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3<Pack> world{dot(rows[0], axes[c]), dot(rows[1], axes[c]),
                             dot(rows[2], axes[c])};
      column[c] = {dot(axes[0], world), dot(axes[1], world), dot(axes[2], world)};
    }
  }

  Vec3<Pack> operator*(const Vec3<Pack>& x) const {
    return x.x * column[0] + x.y * column[1] + x.z * column[2];
  }

  Vec3<Pack> column[3];
};

}  // namespace tress
