#pragma once

#include <Eigen/Core>

namespace tress {

/// Decompositions of dense matrices, O(n^3), instantiated here once: each costs some
/// seconds of compile time per use.

/// Solves a x = b by LU.
Eigen::MatrixXd solution(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// Minimises |a x - b| by columns; x is the vector of least norm where columns of a
/// depend on each other.
Eigen::MatrixXd least_squares_solution(const Eigen::MatrixXd& a,
                                       const Eigen::MatrixXd& b);
/// The pseudoinverse; pivots below `dependence` times the largest one count as none.
Eigen::MatrixXd pseudoinverse(const Eigen::MatrixXd& a, double dependence);
/// An orthonormal basis, by columns, of the x with a x = 0, by such pivots.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& a, double dependence);
/// An orthonormal basis of the orthogonal complement of independent columns.
Eigen::MatrixXd complement(const Eigen::MatrixXd& columns);
/// Whether a symmetric matrix is positive definite.
bool is_definite(const Eigen::MatrixXd& symmetric);

}  // namespace tress
