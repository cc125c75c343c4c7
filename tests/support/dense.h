#pragma once

#include <Eigen/Core>

/// Decompositions of dense matrices that tests compare with, compiled once: each takes
/// the compiler ten seconds wherever it stands.
namespace tress::testing_support {

/// X with A X = B by LU with full pivoting, A regular.
Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The X of least norm that minimises |A X - B|; pivots below `threshold` of the largest
/// count as zero, below rounding unless given.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                              double threshold = 0);

Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);  // descending
Eigen::Index rank(const Eigen::MatrixXd& a);
/// Q of the QR decomposition of a square matrix.
Eigen::MatrixXd orthogonal(const Eigen::MatrixXd& a);

}  // namespace tress::testing_support
