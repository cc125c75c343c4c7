#pragma once

#include <Eigen/Core>

#include "experiments/statics/static_strand.h"

namespace tress::experiments::statics {

/// Eigenvalues of the stiffness of an equilibrium, on the displacements dq that its
/// constraints allow: those of Q^T D K D Q over EI/L. Here K = dR/dq, D has the typical
/// sizes of the coordinates, and the columns of Q are orthonormal with G D Q = 0. The
/// signs of the eigenvalues do not depend on D. The equilibrium is stable if all are
/// positive.
///
/// Loads that follow the strand make K unsymmetric. The eigenvalues are then the squares
/// omega^2 of small motions, over EI/(rho A L^4), and may be complex.
struct Stability {
  Eigen::VectorXd values;   // ascending (real parts), without those of neutral modes
  int negative = 0;         // number of values below 0
  bool symmetric = true;    // whether K is
  bool oscillates = false;  // true: some values are complex, a growing oscillation
  Eigen::MatrixXd shapes;   // (n x values) displacements; empty: K is unsymmetric
  /// Displacements without energy, such as the spin of a straight strand about itself.
  Eigen::MatrixXd neutral;
  int lifted = 0;  // number of the neutral modes that a load has made stiff or unstable
  bool apart = true;  // whether their eigenvalues are smaller than all others
};

/// Eigenvalues below this count as those of neutral modes, for rounding leaves no exact
/// zero.
inline constexpr double neutral_limit = 1e-7;

/// Computes the eigenvalues. `neutral_modes`: number of neutral modes of the path, which
/// is then independent of values that cross 0; negative: all values below neutral_limit.
/// O(n^3).
Stability stability(StaticStrand& strand, const Balance& at, int neutral_modes = -1);

}  // namespace tress::experiments::statics
