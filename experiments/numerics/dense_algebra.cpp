#include "experiments/numerics/dense_algebra.h"

#include <Eigen/Eigenvalues>
#include <utility>

namespace tress::experiments {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MixedSolution mixed_solution(MatrixXd a, VectorXd b, In typical) {
  VectorXd size(a.cols());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    size[j] = at < typical.size() ? typical[at] : 1 / a.col(j).cwiseAbs().maxCoeff();
  }
  a = a * size.asDiagonal();
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double entry = a.row(i).cwiseAbs().maxCoeff();
    a.row(i) /= entry;
    b[i] /= entry;
  }
  return {solution(a, b), std::move(size)};
}

Eigen::VectorXcd eigenvalues(const MatrixXd& matrix) {
  return Eigen::EigenSolver<MatrixXd>(matrix, false).eigenvalues();
}

VectorXd symmetric_eigenvalues(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

Eigenpairs real_eigenpairs(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> pairs(matrix);
  return {pairs.eigenvalues().real(), pairs.eigenvectors().real()};
}

Eigenpairs symmetric_eigenpairs(const MatrixXd& a, const MatrixXd& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> pairs(a, b);
  return {pairs.eigenvalues(), pairs.eigenvectors()};
}

}  // namespace tress::experiments
