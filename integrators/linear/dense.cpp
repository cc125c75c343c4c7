#include "integrators/linear/dense.h"

#include <Eigen/Dense>

namespace tress {

struct DenseSolver::Matrices {
  Eigen::MatrixXd a;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  Eigen::VectorXd x;
};

DenseSolver::DenseSolver(const Pattern& pattern)
    : DirectSolver(pattern), dense_(std::make_unique<Matrices>()) {
  dense_->a.resize(pattern.rows, pattern.cols);
  dense_->x.resize(pattern.rows);
}

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
  dense_->lu.compute(dense_->a);
  return a.cols == 0 ? 1.0 : dense_->lu.matrixLU().diagonal().cwiseAbs().minCoeff();
}

void DenseSolver::solve_scaled(InOut b) const noexcept {
  Eigen::Map<Eigen::VectorXd> x(b.data(), static_cast<Eigen::Index>(b.size()));
  dense_->x.noalias() = dense_->lu.permutationP() * x;
  dense_->lu.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(dense_->x);
  dense_->lu.matrixLU().triangularView<Eigen::Upper>().solveInPlace(dense_->x);
  x = dense_->x;
}

}  // namespace tress
