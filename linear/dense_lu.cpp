#include "linear/dense_lu.h"

namespace tress {

double DenseLu::factor(const Eigen::MatrixXd& a) noexcept {
  lu_.compute(a);
  return a.cols() == 0 ? 1.0 : lu_.matrixLU().diagonal().cwiseAbs().minCoeff();
}

void DenseLu::solve(Eigen::Ref<Eigen::VectorXd> b) const noexcept {
  permuted_.noalias() = lu_.permutationP() * b;
  lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(permuted_);
  lu_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(permuted_);
  b = permuted_;
}

}  // namespace tress
