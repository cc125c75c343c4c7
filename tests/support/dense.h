#pragma once

#include <Eigen/Core>

/// Decompositions of dense matrices that tests compare with: GSL's, where the testbed
/// itself has Eigen's.
namespace tress::testing_support {

/// X with A X = B by LU, A regular.
Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The X of least norm that minimises |A X - B|; singular values below `threshold` of
/// the largest count as zero, below rounding unless given.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                              double threshold = 0);

Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);  // descending
Eigen::Index rank(const Eigen::MatrixXd& a);
/// Q of the QR decomposition of a square matrix.
Eigen::MatrixXd orthogonal(const Eigen::MatrixXd& a);

}  // namespace tress::testing_support
