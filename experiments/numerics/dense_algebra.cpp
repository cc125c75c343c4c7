#include "experiments/numerics/dense_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <utility>

#include "linear/dense_lu.h"

namespace tress::experiments {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd solution(const MatrixXd& a, const MatrixXd& b) {
  DenseLu lu(a.rows());
  lu.factor(a);
  MatrixXd x = b;
  for (Eigen::Index j = 0; j < x.cols(); ++j) lu.solve(x.col(j));
  return x;
}

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

VectorXd least_squares_solution(const MatrixXd& a, const VectorXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd complement(const MatrixXd& columns) {
  if (columns.cols() == 0) return MatrixXd::Identity(columns.rows(), columns.rows());
  const Eigen::HouseholderQR<MatrixXd> qr(columns);
  return MatrixXd(qr.householderQ()).rightCols(columns.rows() - columns.cols());
}

bool is_definite(const MatrixXd& symmetric) {
  return Eigen::LLT<MatrixXd>(symmetric).info() == Eigen::Success;
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
