#include "models/effects/coupled_solver.h"

#include <algorithm>
#include <utility>

#include "linear/finite.h"

namespace tress::models {

CoupledSolver::CoupledSolver(std::vector<const Pattern*> uncoupled,
                             std::vector<Mean> means)
    : uncoupled_(std::move(uncoupled)), means_(std::move(means)) {}

void CoupledSolver::follow() {
  std::ranges::sort(touching_);
  touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
  if (solver_ && touching_ == touched_) return;
  touched_ = touching_;
  int n = 0;
  for (const Pattern* pattern : uncoupled_) n += pattern->rows;
  CouplingColumns columns(n, means_);
  for (const FourPoints& four : touched_) columns.add(four);
  coupling_ = std::move(columns).pattern();
  coupling_values_.resize(static_cast<std::size_t>(coupling_.nonzeros()));
  matrix_ = std::make_unique<BlockMatrix>(n, n);
  int first = 0;
  for (const Pattern* pattern : uncoupled_) {
    matrix_->add_block(*pattern, first, first);
    first += pattern->rows;
  }
  matrix_->add_block(coupling_, 0, 0);
  matrix_->finish();
  solver_ = make_linear_solver(LinearKind::klu, matrix_->pattern());
}

void CoupledSolver::clear() noexcept {
  matrix_->clear();
  std::ranges::fill(coupling_values_, 0.0);
}

void CoupledSolver::add(std::size_t uncoupled, In values) noexcept {
  matrix_->add(static_cast<int>(uncoupled), 1, values);
}

void CoupledSolver::add(const Coupling& contact, Weights w) noexcept {
  add_coupling(coupling_, means_, contact, -w.pos, -w.vel, coupling_values_);
}

Status CoupledSolver::factor() noexcept {
  matrix_->add(static_cast<int>(uncoupled_.size()), 1, coupling_values_);
  if (!all_finite(matrix_->values())) return Status::retry;
  return solver_->factor(matrix_->values());
}

}  // namespace tress::models
