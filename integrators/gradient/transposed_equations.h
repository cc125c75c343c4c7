#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contract/forms/transposed_form.h"
#include "integrators/formulation/dynamics.h"
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
/// The derivatives are the matrices of SparseForm where the system has one; those of
/// constraints are columns by central differences. With TransposedForm they are its
/// products, and S^-T has the solutions of n unit vectors as its rows. Else they are
/// columns by central differences, O(n) residuals.
class TransposedEquations {
 public:
  /// `sparse`: whether the SparseForm is all of dr/dq and dr/dv, which it is not where
  /// effects couple distant points. `system` must outlive this.
  TransposedEquations(System& system, const Options& options, bool sparse);

  std::size_t n() const { return n_; }
  std::size_t m() const { return m_; }
  /// Computes the accelerations and multipliers of a motion from q and v.
  Status accelerate(WatchedSystem::Motion& motion) noexcept {
    return dynamics_.accelerate(motion.t, motion.q, motion.v, motion.a, motion.lambda);
  }
  /// Linearizes at a state, which must last until the next call, and factors.
  Status move(const WatchedSystem::Motion& state, Weights w) noexcept;
  /// Solves for x = (mu, nu), (n + m), from b in the first n numbers.
  Status solve(InOut x) noexcept;
  void pull(In x, InOut q_hat, InOut v_hat) noexcept;

 private:
  Status by_products(const WatchedSystem::Motion& state, Weights w) noexcept;
  Status by_columns(const WatchedSystem::Motion& state) noexcept;
  Status by_matrices(const WatchedSystem::Motion& state) noexcept;
  Status column(std::size_t k, std::size_t j) noexcept;
  bool matrices_alone() const { return sparse_ != nullptr && m_ == 0; }
  /// On pattern_.
  const std::array<std::vector<double>, 3>& derivatives() const {
    return matrices_alone() ? sparse_by_ : by_;
  }

  Dynamics dynamics_;
  SparseForm* sparse_;          // null: not used
  TransposedForm* transposed_;  // null: not used
  bool products_ = false;       // in use at this state
  std::size_t n_, m_;
  Pattern pattern_;                               // (n + m) x n, of each of by_
  std::array<std::vector<double>, 3> by_;         // q, v, a
  std::array<std::vector<double>, 3> sparse_by_;  // the same of r alone, by matrices
  std::array<std::vector<double>, 3> typ_;        // typical sizes of q, v, a
  WatchedSystem::Motion at_;                      // shifted
  std::vector<double> before_r_, before_c_;
  bool mass_known_ = false;  // sparse_by_ has a mass that is constant
  BlockMatrix matrix_;       // transposed
  int of_r_, of_lambda_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> inverse_;  // (n x n) S^-1, column by column
  std::vector<double> product_q_, product_v_;
  std::vector<double> combined_, gradient_;
};

}  // namespace tress::integrators
