#pragma once

#include "math/vec3.h"
#include "models/reduced/tree_tangent.h"

namespace tress::models {

/// The directions in which the frames of a strand move. With two or three unknowns per
/// segment this is all of space; a strand with one unknown per segment (bending about e1
/// only) stays in its plane of e0 and e2: two translations and one rotation.
template <int dofs>
struct Space {
  static constexpr int translations = dofs == 1 ? 2 : 3;
  static constexpr int rotations = dofs == 1 ? 1 : 3;
  static constexpr int size = translations + rotations;
  static constexpr int translation[3] = {0, dofs == 1 ? 2 : 1, 2};
  static constexpr int rotation[3] = {dofs == 1 ? 1 : 0, 1, 2};
  /// Index in (twist, curvature 1, curvature 2) of unknown k of a segment.
  static constexpr int component(int k) { return dofs == 3 ? k : k + 1; }
  static constexpr Vec axis(int component) {
    return {component == 0 ? 1.0 : 0, component == 1 ? 1.0 : 0, component == 2 ? 1.0 : 0};
  }
};

template <int dofs, class Real = double>
using MassShape = TreeShape<Space<dofs>::size, Space<dofs>::size, dofs, Real>;

template <int dofs>
using ExactShape = TreeShape<3 * Space<dofs>::size, Space<dofs>::size, dofs>;

}  // namespace tress::models
