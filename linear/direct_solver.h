#pragma once

#include <limits>
#include <vector>

#include "contract/pattern.h"
#include "linear/linear_solver.h"

namespace tress {

/// Base of all direct solvers: scaling, singularity test, condition estimate.
///
/// The factored matrix is R A C. Rows and columns are divided by the square roots of
/// their largest magnitudes, three times, then columns by their largest magnitude [Ruiz
/// 2001, RAL-TR-2001-034]. The first part keeps symmetry, so mixed units and masses (D A
/// D) cancel. Every column of R A C has size one, so pivots need no further scaling. With
/// a pivot at or below `singular_pivot` the matrix counts as singular. Scaling costs
/// O(nonzeros) on top of the factorisation.
///
/// condition() estimates |R A C| |(R A C)^-1|, computed on request by two solves (the
/// power method on the inverse from a scattered start). It is a lower bound of the
/// product of the 1-norm and the inverse's 2-norm. The first solve alone reaches
/// |inverse| / sqrt(n) in the mean, so only the order of magnitude is guaranteed. KLU's
/// own klu_condest is not used: it takes up to ten solves and measures A unscaled.
class DirectSolver : public LinearSolver {
 public:
  /// Rounding leaves the last pivot of a singular matrix at a small multiple of the
  /// roundoff, which grows with n only as far as elimination mixes entries: 128
  /// roundoffs.
  static constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

  /// Allocates for a pattern; `singular_pivot` is relative to entries of R A C.
  explicit DirectSolver(const Pattern& pattern, double singular_pivot = rounding);

  Status factor(In values) noexcept final;
  Status solve(InOut b) noexcept final;
  double condition() const noexcept final;

 protected:
  const Pattern& pattern() const { return pattern_; }

 private:
  /// Factors R A C; returns the smallest magnitude of a pivot, 0 on breakdown.
  virtual double factor_scaled(In values) noexcept = 0;
  virtual void solve_scaled(InOut b) const noexcept = 0;

  bool scale(In values) noexcept;
  void measure(In values) noexcept;
  double amplification(InOut x) const noexcept;

  Pattern pattern_;
  double singular_pivot_;
  std::vector<double> scaled_;
  std::vector<double> row_scale_;
  std::vector<double> column_scale_;
  std::vector<double> row_largest_, column_largest_;
  mutable std::vector<double> probe_;
  mutable double condition_ = 0;  // 0: not computed since the last factorisation
  double norm_ = 0;               // 1-norm of R A C
  bool factored_ = false;
};

}  // namespace tress
