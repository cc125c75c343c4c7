#include "models/coupling/coupled_solver.h"

#include <algorithm>
#include <utility>

#include "linear/finite.h"
#include "linear/sparse_pattern.h"

namespace tress::models {
namespace {

/// Pattern of the derivatives of contacts between points that are means of coordinates
/// (each P q).
Pattern coupling_pattern(int coordinates, const std::vector<CoupledPoints>& contacts,
                         const std::vector<MaterialPoints::Mean>& means) {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(coordinates));
  std::vector<int> all;
  for (const CoupledPoints& contact : contacts) {
    all.clear();
    for (const std::size_t point : contact) {
      const MaterialPoints::Mean& mean = means[point];
      for (int n = 0; n < mean.count; ++n) {
        const int c = mean.coordinate[static_cast<std::size_t>(n)];
        all.insert(all.end(), {c, c + 1, c + 2});
      }
    }
    for (const int c : all) {
      auto& column = columns[static_cast<std::size_t>(c)];
      column.insert(column.end(), all.begin(), all.end());
    }
  }
  return pattern_of(coordinates, std::move(columns));
}

/// values += P^T (pos df/dx + vel df/dv) P on that pattern.
void add_coupling(const Pattern& pattern, const std::vector<MaterialPoints::Mean>& means,
                  const Coupling& contact, double pos, double vel,
                  InOut values) noexcept {
  const auto add = [&](const MaterialPoints::Mean& row,
                       const MaterialPoints::Mean& column, const double* block) {
    for (std::size_t m = 0; m < static_cast<std::size_t>(row.count); ++m) {
      for (std::size_t n = 0; n < static_cast<std::size_t>(column.count); ++n) {
        const double weight = row.weight[m] * column.weight[n];
        for (int j = 0; j < 3; ++j) {
          const int place =
              place_of(pattern, row.coordinate[m], column.coordinate[n] + j);
          double* at = &values[static_cast<std::size_t>(place)];
          for (int i = 0; i < 3; ++i) at[i] += weight * block[3 * i + j];
        }
      }
    }
  };
  for (std::size_t i = 0; i < contact.ends.size(); ++i) {
    for (std::size_t j = 0; j < contact.ends.size(); ++j) {
      std::array<double, 9> block{};
      contact.add_block(i, j, pos, vel, block.data());
      add(means[contact.ends[i].point], means[contact.ends[j].point], block.data());
    }
  }
}

}  // namespace

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
  coupling_ = coupling_pattern(n, touched_, means_);
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
