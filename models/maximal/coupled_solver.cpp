#include "models/maximal/coupled_solver.h"

#include <algorithm>

#include "linear/finite.h"

namespace tress::models {

Status CoupledSolver::factor(In values, const std::vector<Coupling>& contacts,
                             Weights w) {
  touching_.clear();
  for (const Coupling& contact : contacts) {
    FourPoints points;
    for (std::size_t a = 0; a < 4; ++a) points[a] = contact.ends[a].point;
    touching_.push_back(points);
  }
  std::ranges::sort(touching_);
  touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
  if (!solver_ || touching_ != touched_) build();

  std::ranges::fill(coupling_values_, 0.0);
  for (const Coupling& contact : contacts) {
    add_coupling(coupling_, means_, contact, -w.pos, -w.vel, coupling_values_);
  }
  matrix_->clear();
  matrix_->add(0, 1, values);
  matrix_->add(1, 1, coupling_values_);
  if (!all_finite(matrix_->values())) return Status::retry;
  return solver_->factor(matrix_->values());
}

void CoupledSolver::build() {
  touched_ = touching_;
  const int n = uncoupled_.rows;
  CouplingColumns columns(n, means_);
  for (const FourPoints& points : touched_) columns.add(points);
  coupling_ = std::move(columns).pattern();
  coupling_values_.resize(static_cast<std::size_t>(coupling_.nonzeros()));
  matrix_ = std::make_unique<BlockMatrix>(n, n);
  matrix_->add_block(uncoupled_, 0, 0);
  matrix_->add_block(coupling_, 0, 0);
  matrix_->finish();
  solver_ = make_linear_solver(LinearKind::klu, matrix_->pattern());
}

}  // namespace tress::models
