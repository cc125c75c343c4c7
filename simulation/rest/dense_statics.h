#pragma once

#include <Eigen/Core>

#include "contract/forms/natural_strains.h"

namespace tress::simulation {

/// Statics of a system without motion at t = 0 and q, linearised. Displacements that its
/// constraints allow are dq = Z y. The stiffness is the symmetric part of Z^T (dr/dq -
/// d(G^T lambda)/dq) Z at the natural strains of the first call. It comes from the sparse
/// form if there is one, otherwise from the tangent, which must be the exact one. Dense,
/// O(n^3).
class DenseStatics {
 public:
  /// Throws std::runtime_error where the system cannot be evaluated.
  DenseStatics(System& system, In q);

  /// The residual that constraints do not take up, Z^T r, for the present natural
  /// strains.
  Eigen::VectorXd residual();
  /// Returns Z^T K Z.
  const Eigen::MatrixXd& stiffness();
  /// Z^T K (to - from), of two states.
  Eigen::VectorXd pull(In from, In to);
  /// Computes Z^T dr/dnatural.
  Eigen::MatrixXd by_natural(NaturalStrains& strains);
  /// Displacements of all coordinates, a column each.
  Eigen::MatrixXd displacement(const Eigen::MatrixXd& y) const;
  /// Typical sizes of the coordinates.
  const Eigen::VectorXd& scale() const { return scale_; }

 private:
  Eigen::VectorXd full_residual();
  void take_constraints();

  System& system_;
  Eigen::VectorXd q_, zero_, scale_;
  Eigen::MatrixXd basis_;      // Z; empty: all
  Eigen::VectorXd lambda_;     // of the constraints, by least squares
  Eigen::MatrixXd stiffness_;  // empty: not asked for yet
};

/// Least s > 0 for which a + (s - 1) b is positive definite, b positive semidefinite: 0
/// if it is for the smallest s tried, infinity if it is for none.
double least_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// x that minimises |m x - b|^2 + (ridge |m|)^2 |x|^2, for every column of b: |m| the
/// largest norm of a column.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& m, const Eigen::MatrixXd& b,
                              double ridge);

/// x >= 0 that minimises |a x - b|^2 + (ridge |a|)^2 |x|^2, by active sets [Lawson &
/// Hanson 1974, Solving Least Squares Problems, algorithm NNLS].
Eigen::VectorXd nonnegative(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                            double ridge);

}  // namespace tress::simulation
