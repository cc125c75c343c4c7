#pragma once

#include <Eigen/Core>

#include "contract/system.h"

/// Dense matrices of a system at rest, for full decompositions.
namespace tress::experiments {

/// M = dr/da at (t, q): from the sparse form if the system has it, else column by column
/// from the residual, which is linear in a. Throws std::runtime_error where the residual
/// cannot be evaluated.
Eigen::MatrixXd dense_mass(System& system, double t, In q);

/// K = dr/dq at v = a = 0: from the sparse form, which then must have the exact tangent,
/// else by central differences of the residual (error 1e-10 of its largest entries).
Eigen::MatrixXd dense_stiffness(System& system, double t, In q);

/// Gradients of the constraints, one per column (n x m).
Eigen::MatrixXd dense_gradient(System& system, double t, In q);

/// d(G^T lambda)/dq.
Eigen::MatrixXd dense_curvature(System& system, double t, In q, In lambda);

}  // namespace tress::experiments
