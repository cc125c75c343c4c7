#pragma once

#include <Eigen/Core>

#include "contract/layers.h"

/// Decompositions of dense matrices, O(n^3), compiled once: each takes the compiler some
/// seconds wherever it is used.
namespace tress::experiments {

/// x of a x = b, by LU.
Eigen::MatrixXd solution(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// x of the least |a x - b|, columns of full rank.
Eigen::VectorXd least_squares_solution(const Eigen::MatrixXd& a,
                                       const Eigen::VectorXd& b);
/// An orthonormal base of what is orthogonal to independent columns.
Eigen::MatrixXd complement(const Eigen::MatrixXd& columns);
/// Whether a symmetric matrix is positive definite.
bool is_definite(const Eigen::MatrixXd& symmetric);

/// Of a general square matrix, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);
/// Of a symmetric one, ascending.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Columns of `vectors` belong to `values`.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// The real parts, in no order.
Eigenpairs real_eigenpairs(const Eigen::MatrixXd& matrix);
/// a x = value b x, a symmetric and b symmetric and positive definite, ascending.
Eigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace tress::experiments
