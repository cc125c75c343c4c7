#include "linear/dense.h"

#include "linear/dense_lu.h"
#include "linear/sparse_pattern.h"

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
  to_dense(pattern(), values,
           {dense_->a.data(), static_cast<std::size_t>(dense_->a.size())});
  return dense_->lu.factor(dense_->a);
}

void DenseSolver::solve_scaled(InOut b) const noexcept {
  dense_->lu.solve(
      Eigen::Map<Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size())));
}

}  // namespace tress
