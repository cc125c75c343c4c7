#pragma once

#include <vector>

#include "integrators/linear/linear_solver.h"

namespace tress {

/// What every direct solver shares: scaling, the test for singularity, the condition.
///
/// The factored matrix is R A C: R divides each row, then C each column, by its largest
/// magnitude. Every column of R A C then has size one, so a pivot can be read as it
/// stands: below `singular_pivot` times the unit roundoff the matrix counts as singular,
/// however badly A itself was scaled. O(nonzeros) on top of the factorisation.
///
/// condition() estimates |R A C| |(R A C)^-1|, computed on request by two solves (the power
/// method on the inverse from a scattered start). It is a lower bound of the product of the
/// 1-norm and the inverse's 2-norm; the first solve alone reaches |inverse| / sqrt(n) in the
/// mean, so the right order of magnitude is promised and no more. klu_condest was not used:
/// it takes up to ten solves and measures A unscaled.
class DirectSolver : public LinearSolver {
 public:
  explicit DirectSolver(const Pattern& pattern);

  Status factor(In values) noexcept final;
  Status solve(InOut b) noexcept final;
  double condition() const noexcept final;

 protected:
  const Pattern& pattern() const { return pattern_; }

 private:
  /// Factors R A C; returns the smallest magnitude of a pivot, 0 where it broke down.
  virtual double factor_scaled(In values) noexcept = 0;
  virtual void solve_scaled(InOut b) const noexcept = 0;

  bool scale(In values) noexcept;
  double amplification(InOut x) const noexcept;

  Pattern pattern_;
  std::vector<double> scaled_;
  std::vector<double> row_scale_;
  std::vector<double> column_scale_;
  mutable std::vector<double> probe_;
  mutable double condition_ = 0;  // 0: not computed since the last factorisation
  double norm_ = 0;               // 1-norm of R A C
  bool factored_ = false;
};

}  // namespace tress
