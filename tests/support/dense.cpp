#include "tests/support/dense.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace tress::testing_support {

Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.fullPivLu().solve(b);
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                              double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  if (threshold > 0) decomposition.setThreshold(threshold);
  return decomposition.compute(a).solve(b);
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& a) {
  return a.jacobiSvd().singularValues();
}

Eigen::Index rank(const Eigen::MatrixXd& a) { return a.fullPivLu().rank(); }

Eigen::MatrixXd orthogonal(const Eigen::MatrixXd& a) {
  return a.householderQr().householderQ();
}

}  // namespace tress::testing_support
