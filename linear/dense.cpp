#include "linear/dense.h"

#include "linear/dense_lu.h"

namespace tress {

struct DenseSolver::Matrices {
  explicit Matrices(Eigen::Index size) : a(size, size), lu(size) {}
  Eigen::MatrixXd a;
  DenseLu lu;
};

DenseSolver::DenseSolver(const Pattern& pattern)
    : DirectSolver(pattern), dense_(std::make_unique<Matrices>(pattern.rows)) {}

DenseSolver::~DenseSolver() = default;

double DenseSolver::factor_scaled(In values) noexcept {
  const Pattern& a = pattern();
  dense_->a.setZero();
  for (int j = 0; j < a.cols; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int p = a.start[column]; p < a.start[column + 1]; ++p) {
      const auto entry = static_cast<std::size_t>(p);
      dense_->a(a.row[entry], j) = values[entry];
    }
  }
  return dense_->lu.factor(dense_->a);
}

void DenseSolver::solve_scaled(InOut b) const noexcept {
  dense_->lu.solve(
      Eigen::Map<Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size())));
}

}  // namespace tress
