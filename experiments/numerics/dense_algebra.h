#pragma once

#include <Eigen/Core>

#include "contract/basics.h"
#include "contract/layers.h"
#include "linear/dense_algebra.h"

/// Eigenvalues of dense matrices, O(n^3), instantiated here once: each decomposition
/// costs some seconds of compile time per use.
namespace tress::experiments {

/// Solution of equations whose unknowns have different units.
struct MixedSolution {
  Eigen::VectorXd scaled;  // the unknowns over their sizes
  Eigen::VectorXd size;    // sizes of the unknowns
  /// Returns the unknowns.
  Eigen::VectorXd unknowns() const { return size.cwiseProduct(scaled); }
};
/// Solves a x = b by LU, with rows divided by their largest entries. `typical` has the
/// sizes of the first unknowns. The size of any other unknown is the inverse of the
/// largest entry of its column.
MixedSolution mixed_solution(Eigen::MatrixXd a, Eigen::VectorXd b, In typical);

/// Eigenvalues of a general square matrix, unordered.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);
/// Returns the eigenvalues in ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Column i of `vectors` belongs to values[i].
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// The real parts, unordered.
Eigenpairs real_eigenpairs(const Eigen::MatrixXd& matrix);
/// Solves a x = value b x, a symmetric, b symmetric positive definite; ascending.
Eigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace tress::experiments
