#pragma once

#include <Eigen/Core>

#include "contract/system.h"

/// The matrices of a system at rest as dense ones, for decompositions of the whole.
namespace tress::experiments {

/// M = dr/da at (t, q): from the sparse form where there is one, else column by column
/// from the residual, which is linear in a. Throws std::runtime_error where the residual
/// has no value.
Eigen::MatrixXd dense_mass(System& system, double t, In q);

/// K = dr/dq at v = a = 0: from the sparse form, which then must have the exact tangent,
/// else by central differences of the residual (1e-10 of its largest entries).
Eigen::MatrixXd dense_stiffness(System& system, double t, In q);

/// Gradients of the constraints, one a column (n x m).
Eigen::MatrixXd dense_gradient(System& system, double t, In q);

/// d(G^T lambda)/dq.
Eigen::MatrixXd dense_curvature(System& system, double t, In q, In lambda);

}  // namespace tress::experiments
