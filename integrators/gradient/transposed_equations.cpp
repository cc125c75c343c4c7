#include "integrators/gradient/transposed_equations.h"

#include <algorithm>
#include <functional>

#include "linear/sparse_pattern.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

Pattern full_pattern(std::size_t rows, std::size_t columns) {
  std::vector<int> column(rows);
  for (std::size_t i = 0; i < rows; ++i) column[i] = static_cast<int>(i);
  return pattern_of(static_cast<int>(rows),
                    std::vector<std::vector<int>>(columns, column));
}

/// y -= A^T x
void subtract_transposed(const Pattern& pattern, In values, In x, InOut y) {
  for (std::size_t j = 0; j < y.size(); ++j) {
    double sum = 0;
    for (int p = pattern.start[j]; p < pattern.start[j + 1]; ++p) {
      sum += values[size(p)] * x[size(pattern.row[size(p)])];
    }
    y[j] -= sum;
  }
}

}  // namespace

TransposedEquations::TransposedEquations(System& system, const Options& options,
                                         KnownForces forces)
    : dynamics_(system, options),
      derivative_(dynamics_, {forces.sparse && dynamics_.m() > 0, forces.quadratic},
                  nullptr),
      sparse_(forces.sparse && dynamics_.m() == 0 ? system.sparse_form() : nullptr),
      transposed_(dynamics_.m() == 0 ? transposed_form(system) : nullptr),
      n_(size(dynamics_.n())),
      m_(size(dynamics_.m())),
      pattern_(sparse_ != nullptr ? sparse_->pattern() : full_pattern(n_ + m_, n_)),
      matrix_(static_cast<int>(n_ + m_), static_cast<int>(n_ + m_)),
      of_r_(matrix_.add_block(pattern_, 0, 0, true)),
      of_lambda_(0),
      right_(n_),
      product_q_(n_),
      product_v_(n_),
      none_(n_),
      unit_(n_) {
  if (m_ > 0) {
    const Pattern& gradient = dynamics_.constraints()->pattern();
    of_lambda_ = matrix_.add_block(gradient, static_cast<int>(n_), 0, true);
    gradient_.resize(size(gradient.nonzeros()));
  }
  matrix_.finish();
  solver_ = make_linear_solver(sparse_ != nullptr ? options.linear : LinearKind::dense,
                               matrix_.pattern());
  for (auto& values : by_) values.resize(size(pattern_.nonzeros()));
  combined_.resize(by_[0].size());
}

Status TransposedEquations::move(const WatchedSystem::Motion& state, Weights w) noexcept {
  products_ = transposed_ != nullptr &&
              transposed_->factor_transposed(state.t, state.q, state.v, state.a, w);
  if (products_) return Status::ok;
  of_mass_ = m_ > 0 && w.pos == 0 && w.vel == 0;
  if (of_mass_) return by_columns(state, 2);
  Status s = sparse_ != nullptr ? by_matrices(state) : by_columns(state, by_.size());
  if (s != Status::ok) return s;
  for (std::size_t p = 0; p < combined_.size(); ++p) {
    combined_[p] = w.acc * by_[2][p] + w.vel * by_[1][p] + w.pos * by_[0][p];
  }
  matrix_.clear();
  matrix_.add(of_r_, 1, combined_);
  if (m_ > 0) {
    s = dynamics_.constraints()->gradient(state.t, state.q, gradient_);
    if (s != Status::ok) return s;
    matrix_.add(of_lambda_, -1, gradient_);
  }
  return solver_->factor(matrix_.values());
}

Status TransposedEquations::by_matrices(const WatchedSystem::Motion& at) noexcept {
  constexpr Weights weights[] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  for (std::size_t k = 0; k < (mass_known_ ? 2 : by_.size()); ++k) {
    const Status s = sparse_->values(at.t, at.q, at.v, at.a, weights[k], by_[k]);
    if (s != Status::ok) return s;
  }
  mass_known_ = dynamics_.system().traits().constant_mass;
  return Status::ok;
}

/// By q and v, and by a if these are 3 kinds.
Status TransposedEquations::by_columns(const WatchedSystem::Motion& at,
                                       std::size_t kinds) noexcept {
  Status s = derivative_.move(at.t, at.q, at.v, at.a, at.lambda);
  for (std::size_t k = 0; k < kinds; ++k) {
    for (std::size_t j = 0; j < n_ && s == Status::ok; ++j) {
      unit_[j] = 1;
      const auto column = Out(by_[k]).subspan(j * (n_ + m_), n_ + m_);
      s = derivative_.along(k == 0 ? unit_ : none_, k == 1 ? unit_ : none_,
                            k == 2 ? unit_ : none_, column.first(n_), column.subspan(n_));
      unit_[j] = 0;
    }
  }
  return s;
}

Status TransposedEquations::solve(InOut x) noexcept {
  if (products_) {
    std::ranges::copy(x, right_.begin());
    return transposed_->solve_transposed(right_, x, product_q_, product_v_);
  }
  if (of_mass_) {
    nu_.assign(m_, 0.0);
    const Status s = dynamics_.solve(x.first(n_), nu_);
    std::ranges::transform(nu_, x.subspan(n_).begin(), std::negate());
    return s;
  }
  std::ranges::fill(x.subspan(n_), 0.0);
  return solver_->solve(x);
}

void TransposedEquations::pull(In x, InOut q_hat, InOut v_hat) noexcept {
  if (products_) {
    add(q_hat, -1, product_q_);
    add(v_hat, -1, product_v_);
    return;
  }
  subtract_transposed(pattern_, by_[0], x, q_hat);
  subtract_transposed(pattern_, by_[1], x, v_hat);
}

}  // namespace tress::integrators
