#pragma once

#include <Eigen/Core>
#include <vector>

#include "contract/system.h"

/// Dense matrices of a system, for full decompositions.
namespace tress::experiments {

/// A state and its acceleration.
struct Instant {
  double t = 0;
  std::vector<double> q, v, a;
};

/// S(w) of the residual: exact in a, in which it is linear; by central differences in q
/// and v (error 1e-10 of its largest entries). Throws std::runtime_error where the
/// residual cannot be evaluated.
Eigen::MatrixXd tangent_of_residual(System& system, const Instant& at, Weights w);

/// M = dr/da at (t, q): from the sparse form if the system has one, else as above.
Eigen::MatrixXd dense_mass(System& system, double t, In q);

/// K = dr/dq at v = a = 0: from the sparse form, which then must have the exact Jacobian,
/// else as above.
Eigen::MatrixXd dense_stiffness(System& system, double t, In q);

/// Gradients of the constraints, one per column (n x m).
Eigen::MatrixXd dense_gradient(System& system, double t, In q);

/// d(G^T lambda)/dq.
Eigen::MatrixXd dense_curvature(System& system, double t, In q, In lambda);

}  // namespace tress::experiments
