#pragma once

#include <memory>
#include <string_view>

#include "contract/pattern.h"
#include "linear/direct_solver.h"

namespace tress {

/// DenseLu, for few unknowns and as the reference for the other solvers.
class DenseSolver final : public DirectSolver {
 public:
  /// Allocates the matrix (n x n) of this pattern.
  explicit DenseSolver(const Pattern& pattern);
  ~DenseSolver() override;
  std::string_view name() const override { return "dense"; }

 private:
  double factor_scaled(In values) noexcept override;
  void solve_scaled(InOut b) const noexcept override;

  struct Matrices;
  std::unique_ptr<Matrices> dense_;
};

}  // namespace tress
