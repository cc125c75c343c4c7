#pragma once

#include "integrators/sundials/dae_form.h"
#include "integrators/sundials/linear_adapter.h"
#include "linear/block_matrix.h"
#include "linear/rank.h"

namespace tress::integrators {

/// IDA's matrix of a DaeForm, dF/dy + cj dF/dy'.
class DaeNewton : public NewtonMatrix {
 public:
  /// Counts of DaeForm's Dynamics plus the cost of solving.
  virtual Stats work() const = 0;
};

/// Without constraints, by one System::solve of size n. The first row gives
/// cj x_q - x_v = b_1; with x_v = z / cj it is x_q = b_1 / cj + z / cj^2, and then
///
///     S z = b_2 - D r,   w = (1, 1/cj, 1/cj^2),   D along dq = b_1 / cj.
class EliminatedNewton final : public DaeNewton {
 public:
  /// Works on `form`, which must outlive it.
  explicit EliminatedNewton(DaeForm& form);
  Status factor(double t, In y, In y_dot, double cj) noexcept override;
  Status solve(InOut b) noexcept override;
  Stats work() const override { return form_.dynamics.stats; }

 private:
  DaeForm& form_;
  double t_ = 0, cj_ = 0;
  Dynamics::Base base_ = Dynamics::Base::fresh;
  std::vector<double> q_, v_, a_, dq_, zero_, r_;
};

/// With constraints, as one sparse unsymmetric matrix of size 2n + m or 2n + 2m for a
/// direct solver. R(u) = d(G u)/dq; K = S(0, 0, 1) - d(G^T lambda)/dq:
///
///     [ cj I - d(G^T mu)/dq   -I           .       -G^T ]
///     [ K                     S(cj, 1, 0)  -G^T     .   ]
///     [ H_q                   H_v           .       .   ]
///     [ G                     .             .       .   ]   (GGL)
///
/// Index 1: H_q = R(v') + beta R(v) + alpha G (without third derivatives of g), H_v = (cj
/// + beta) G + 2 R(v). Index 3: H_q = G, H_v = 0. GGL: H_q = R(v), H_v = G.
///
/// cj and the mass unit s are factored out, so that the condition number does not grow as
/// the step shrinks. Unknowns are (cj x_q, x_v, x_lambda / (cj s), x_mu). The second row
/// is divided by cj s, rows of g'' by cj; rows of g are multiplied by cj. [Bottasso,
/// Bauchau, Cardona, SIAM J. Sci. Comput. 29 (2007) 397] scales index 3 in the same way.
class AssembledNewton final : public DaeNewton {
 public:
  /// Works on `form`, which must outlive it, with the linear solver of the options.
  AssembledNewton(DaeForm& form, const Options& options);
  Status factor(double t, In y, In y_dot, double cj) noexcept override;
  Status solve(InOut b) noexcept override;
  Stats work() const override;

 private:
  Status add_motion(double t, In y, In y_dot) noexcept;
  Status add_constraints(double t, In y, In y_dot) noexcept;
  bool has_redundant_constraints();
  void project_multipliers(InOut b) const;

  DaeForm& form_;
  const double alpha_, beta_;
  BlockMatrix matrix_;
  std::unique_ptr<LinearSolver> solver_;
  int qq_ = 0, q_mu_ = 0, q_unit_ = 0, qv_unit_ = 0, vq_ = 0, vv_ = 0, v_lambda_ = 0;
  int lambda_q_ = 0, lambda_v_ = 0, mu_q_ = 0;  // blocks by row and column
  int multiplier_diagonal_ = 0;
  int rank_deficiency_ = 0;  // redundant constraints met
  std::unique_ptr<NullSpace> null_space_;
  double suspicious_ = 1e11;  // condition above which to look for them
  double cj_ = 0, mass_unit_ = 0;
  std::vector<double> s_, gt_, rate_gt_, ones_, shift_;
  long factors_ = 0, solves_ = 0;
  double condition_ = 0;
};

}  // namespace tress::integrators
