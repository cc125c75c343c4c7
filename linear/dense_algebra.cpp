#include "linear/dense_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "linear/dense_lu.h"

namespace tress {
namespace {

using Eigen::MatrixXd;

using Decomposition = Eigen::CompleteOrthogonalDecomposition<MatrixXd>;

Decomposition decomposed(const MatrixXd& a, double dependence) {
  Decomposition of;
  of.setThreshold(dependence);
  of.compute(a);
  return of;
}

}  // namespace

MatrixXd solution(const MatrixXd& a, const MatrixXd& b) {
  DenseLu lu(a.rows());
  lu.factor(a);
  MatrixXd x = b;
  for (Eigen::Index j = 0; j < x.cols(); ++j) lu.solve(x.col(j));
  return x;
}

MatrixXd least_squares_solution(const MatrixXd& a, const MatrixXd& b) {
  return Decomposition(a).solve(b);
}

MatrixXd pseudoinverse(const MatrixXd& a, double dependence) {
  return decomposed(a, dependence).pseudoInverse();
}

MatrixXd null_space(const MatrixXd& a, double dependence) {
  const Decomposition of = decomposed(a, dependence);
  const Eigen::Index count = a.cols() - of.rank();
  MatrixXd last = MatrixXd::Zero(a.cols(), count);
  last.bottomRows(count).setIdentity();
  // a P = Q [T 0; 0 0] Z: the last rows of Z meet no pivot.
  if (of.rank() < a.cols()) last = of.matrixZ().adjoint() * last;
  return of.colsPermutation() * last;
}

MatrixXd complement(const MatrixXd& columns) {
  if (columns.cols() == 0) return MatrixXd::Identity(columns.rows(), columns.rows());
  const Decomposition of(columns);
  return MatrixXd(of.householderQ()).rightCols(columns.rows() - columns.cols());
}

bool is_definite(const MatrixXd& symmetric) {
  return Eigen::LLT<MatrixXd>(symmetric).info() == Eigen::Success;
}

}  // namespace tress
