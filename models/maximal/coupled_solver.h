#pragma once

#include <memory>
#include <vector>

#include "linear/block_matrix.h"
#include "linear/linear_solver.h"
#include "models/effects/coupling_pattern.h"

namespace tress::models {

/// Solves with a matrix of fixed pattern plus the contacts between distant points, by
/// KLU. The pattern follows the contacts: if other points touch than before, factor()
/// allocates and analyses again.
class CoupledSolver {
 public:
  using Mean = MaterialPoints::Mean;

  /// `uncoupled` must outlive this; `means` are the contact points.
  CoupledSolver(const Pattern& uncoupled, std::vector<Mean> means)
      : uncoupled_(uncoupled), means_(std::move(means)) {}

  /// The uncoupled matrix less w.pos and w.vel times the contacts' derivatives.
  Status factor(In values, const std::vector<Coupling>& contacts, Weights w);
  Status solve(InOut b) noexcept { return solver_->solve(b); }

 private:
  void build();

  const Pattern& uncoupled_;
  std::vector<Mean> means_;
  std::vector<FourPoints> touching_, touched_;  // current, and in the pattern
  Pattern coupling_;
  std::vector<double> coupling_values_;
  std::unique_ptr<BlockMatrix> matrix_;
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace tress::models
