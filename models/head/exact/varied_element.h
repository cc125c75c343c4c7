#pragma once

#include <array>

#include "math/helix.h"
#include "models/head/exact/varied.h"
#include "models/head/reduced_kernel.h"

namespace tress::models {

/// Functions of arc length, which depend on unknowns by what is along them: kappa times
/// its weight.
template <class T>
HelixFunctions<Varied<T>> varied_functions(const HelixFunctions<T>& f,
                                           const Vec3<T>& along) {
  const auto of = [&](const T& x, const T& slope) { return varied(x, slope * along); };
  // The derivative of S is not asked for: that of a rotation follows from its turn.
  return {.S = Varied<T>(f.S),
          .A = of(f.A, f.A1),
          .B = of(f.B, f.B1),
          .A1 = of(f.A1, f.A2),
          .B1 = of(f.B1, f.B2),
          .A2 = of(f.A2, f.A3),
          .B2 = of(f.B2, f.B3),
          .A3 = {},
          .B3 = {}};
}

/// The tip of an element seen from its start, in the components of the latter, with
/// derivatives along the unknowns at weights w.
template <class T>
struct VariedTip {
  VariedVec<T> position, velocity, acceleration;  // motion of the tip
  VariedVec<T> turning, spinning;                 // angular velocity, its rate
  Matrix3<Varied<T>> slope, turn;  // d position/d unknowns; turning = turn rates
  Matrix3<T> rotation;             // from the components of the tip
};

/// A point seen likewise.
template <class T>
struct VariedPoint {
  VariedVec<T> position, velocity;  // motion of the point
  Matrix3<Varied<T>> slope;         // d position/d unknowns
};

/// Wrench of inertia and drag on an element about its start, in the components of the
/// start.
template <class T>
struct VariedWrench {
  VariedVec<T> force, moment, unknown;  // force, moment, and forces on the unknowns
};

/// Sums over the length of an element of w, P its points, d_j = dP/dq_j, P' = sum q_j'
/// d_j.
template <class T, std::size_t functions = 1>
struct ElementSums {
  /// Three unknowns of each function, a matrix row per unknown.
  using Each = std::array<Matrix3<T>, functions>;

  T one;                 // w
  Vec3<T> first;         // w P
  Symmetric3<T> second;  // w P P^T
  Each momentum;         // rows j: w d_j
  Each spin;             // rows j: w P x d_j
  Vec3<T> moved;         // w P'
  Matrix3<T> moving;     // w P' P^T
  /// Rows j: w ((d_j.omega) P + (P.omega) d_j - 2 (d_j.P) omega + 2 P' x d_j). They are
  /// the effect on unknown j of a change of the start's angular velocity omega, through
  /// centrifugal and Coriolis forces.
  Each convective;
};

/// An element of this Kind; defined for each.
template <class Kind>
class VariedElement;

}  // namespace tress::models
