#include "linear/dense_factor.h"

#include <cmath>

namespace tress {

DenseFactor::DenseFactor(int size, bool symmetric)
    : matrix(size, size),
      symmetric_(symmetric),
      rhs_(size),
      scale_(size),
      cholesky_(size),
      lu_(size) {}

Status DenseFactor::factor() noexcept {
  scale_ = matrix.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  if (!scale_.allFinite()) return Status::retry;
  matrix = scale_.asDiagonal() * matrix * scale_.asDiagonal();
  if (symmetric_) {
    cholesky_.compute(matrix);
    return cholesky_.info() == Eigen::Success ? Status::ok : Status::retry;
  }
  const double least = lu_.factor(matrix);
  return least > 0 && std::isfinite(least) ? Status::ok : Status::retry;
}

Status DenseFactor::solve(In b, Out x) noexcept {
  const Eigen::Index n = rhs_.size();
  rhs_ = scale_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
  if (symmetric_) {
    cholesky_.solveInPlace(rhs_);
  } else {
    lu_.solve(rhs_);
  }
  Eigen::Map<Eigen::VectorXd>(x.data(), n) = scale_.cwiseProduct(rhs_);
  return Status::ok;
}

void add_dense_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                       Eigen::MatrixXd& c) {
  c.noalias() += a * b;
}

}  // namespace tress
