#pragma once

#include "math/vec3.h"
#include "models/reduced/tree/tree_tangent.h"

namespace tress::models {

/// The directions in which the frames of a strand move. Modes are the components of
/// strain that are unknowns. With two or three modes the frames move in all of space. A
/// strand with one mode (bending about e1 only) stays in its plane of e0 and e2: two
/// translations and one rotation.
template <int modes>
struct Space {
  /// Number of translations.
  static constexpr int translations = modes == 1 ? 2 : 3;
  /// Number of rotations.
  static constexpr int rotations = modes == 1 ? 1 : 3;
  static constexpr int size = translations + rotations;  // numbers of a wrench
  /// Axis of each translation, 0 to 2; entries from `translations` on are unused.
  static constexpr int translation[3] = {0, modes == 1 ? 2 : 1, 2};
  /// Axis of each rotation, 0 to 2; entries from `rotations` on are unused.
  static constexpr int rotation[3] = {modes == 1 ? 1 : 0, 1, 2};
  /// Index in (twist, curvature 1, curvature 2) of mode k of a segment.
  static constexpr int component(int k) { return modes == 3 ? k : k + 1; }
  /// Returns the unit vector of a component, 0 to 2.
  static constexpr Vec axis(int component) {
    return {component == 0 ? 1.0 : 0, component == 1 ? 1.0 : 0, component == 2 ? 1.0 : 0};
  }
};

/// Segments of `functions` unknowns for each mode.
template <int modes, class Real = double, int functions = 1>
using MassShape =
    TreeShape<Space<modes>::size, Space<modes>::size, modes * functions, Real>;

/// Sizes of problems with the exact Jacobian; `functions` as in the Kernel.
template <int modes, int functions = 1>
using ExactShape =
    TreeShape<3 * Space<modes>::size, Space<modes>::size, modes * functions>;

/// MassShape with the scalar and the functions of a Kernel.
template <class Kernel, int modes>
using MassShapeOf = MassShape<modes, typename Kernel::Real, Kernel::functions>;

/// ExactShape with the functions of a Kernel.
template <class Kernel, int modes>
using ExactShapeOf = ExactShape<modes, Kernel::functions>;

}  // namespace tress::models
