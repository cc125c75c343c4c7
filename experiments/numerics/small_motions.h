#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "contract/basics.h"

namespace tress::experiments {

/// A small motion x(t) = shape exp(i omega t).
struct SmallMotion {
  double square;  // omega^2, 1/s^2
  Eigen::VectorXd shape;
};

/// Returns the solutions of M x'' + K x = columns e with rows x = 0, ascending. M must be
/// positive definite on that subspace. In the symmetric case K = K^T and columns =
/// rows^T. The solutions are then the eigenvalues of M against K + shift M, with the
/// least shift >= 0 that makes it definite. The smallest are thus as accurate as K is,
/// however stiff the rest (stretching, shear). Otherwise they are the real parts of the
/// eigenvalues of M^-1 K and their vectors. `typical`: sizes of the unknowns.
std::vector<SmallMotion> small_motions(const Eigen::MatrixXd& mass,
                                       const Eigen::MatrixXd& stiffness,
                                       const Eigen::MatrixXd& columns,
                                       const Eigen::MatrixXd& rows, In typical);

/// omega^2 of the same, complex where motions grow, ascending by real parts: without the
/// symmetric shortcut, so that a small asymmetric part counts.
std::vector<std::complex<double>> squares_of_motions(const Eigen::MatrixXd& mass,
                                                     const Eigen::MatrixXd& stiffness,
                                                     const Eigen::MatrixXd& columns,
                                                     const Eigen::MatrixXd& rows,
                                                     In typical);

}  // namespace tress::experiments
