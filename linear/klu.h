#pragma once

#include <memory>
#include <string_view>

#include "contract/pattern.h"
#include "linear/direct_solver.h"

namespace tress {

/// General sparse LU. Pivots are chosen once; later factorisations reuse them while the
/// element growth stays small, and are chosen again (with allocation) when it does not.
/// [Davis 2010] T. Davis, E. Palamadai Natarajan, Algorithm 907: KLU, ACM TOMS 37(3).
class KluSolver final : public DirectSolver {
 public:
  /// Analyses the pattern; `singular_pivot` as in DirectSolver.
  explicit KluSolver(const Pattern& pattern, double singular_pivot = rounding);
  ~KluSolver() override;
  std::string_view name() const override { return "klu"; }

 private:
  double factor_scaled(In values) noexcept override;
  void solve_scaled(InOut b) const noexcept override;

  struct Handles;
  std::unique_ptr<Handles> klu_;
};

}  // namespace tress
