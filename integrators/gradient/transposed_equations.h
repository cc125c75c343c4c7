#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contract/forms/transposed_form.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/gradient/residual_derivative.h"
#include "integrators/gradient/watched_system.h"
#include "linear/block_matrix.h"
#include "linear/linear_solver.h"

namespace tress::integrators {

/// The equations of a run at one of its states, linearized and transposed. With R = (r -
/// G^T lambda, c) the equations of Dynamics and S = R_a + w.vel R_v + w.pos R_q,
///
///     [S  -dG^T]^T [mu]   [b]
///     [        ]   [  ] = [ ],    q_hat -= R_q^T (mu, nu),  v_hat -= R_v^T (mu, nu)
///                  [nu]   [0]
///
/// With TransposedForm the system solves and multiplies. Else the derivatives are the
/// matrices of SparseForm where the system has one and no constraints, or columns by
/// central differences, O(n) residuals. Where S is the mass of a start with constraints,
/// which is symmetric, the solution is that of Dynamics: columns lose the digits of the
/// smallest inertia.
class TransposedEquations {
 public:
  /// `forces`: as ResidualDerivative. `system` must outlive this.
  TransposedEquations(System& system, const Options& options, KnownForces forces);

  /// Returns the number of coordinates.
  std::size_t n() const { return n_; }
  /// Returns the number of constraints.
  std::size_t m() const { return m_; }
  /// Computes the accelerations and multipliers of a motion from q and v, before move().
  Status accelerate(WatchedSystem::Motion& motion) noexcept {
    return dynamics_.accelerate(motion.t, motion.q, motion.v, motion.a, motion.lambda);
  }
  /// Linearizes at a state, which must last until the next call, and factors.
  Status move(const WatchedSystem::Motion& state, Weights w) noexcept;
  /// Solves for x = (mu, nu), (n + m), from b in the first n numbers.
  Status solve(InOut x) noexcept;
  /// Returns whether solve() prepares the products of the system's TransposedForm.
  bool products() const { return products_; }
  /// Subtracts R_q^T x from q_hat and R_v^T x from v_hat, x = (mu, nu) of the last
  /// solve().
  void pull(In x, InOut q_hat, InOut v_hat) noexcept;

 private:
  Status by_columns(const WatchedSystem::Motion& state, std::size_t kinds) noexcept;
  Status by_matrices(const WatchedSystem::Motion& state) noexcept;

  Dynamics dynamics_;
  ResidualDerivative derivative_;
  SparseForm* sparse_;          // null: not used
  TransposedForm* transposed_;  // null: not used
  bool products_ = false;       // in use at this state
  bool of_mass_ = false;        // S is the mass, with constraints
  std::size_t n_, m_;
  Pattern pattern_;                        // (n + m) x n, of each of by_
  std::array<std::vector<double>, 3> by_;  // q, v, a
  bool mass_known_ = false;                // by_ has a mass that is constant
  BlockMatrix matrix_;                     // transposed
  int of_r_, of_lambda_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> right_, product_q_, product_v_;  // (n), of products_
  std::vector<double> combined_, gradient_, none_, unit_;
  std::vector<double> nu_;  // (m), of of_mass_
};

}  // namespace tress::integrators
