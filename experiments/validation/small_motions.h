#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/system.h"

namespace tress {

/// omega^2 of M x'' + K x = 0 with x orthogonal to the columns of `constraints`,
/// ascending. M must be positive definite there. Of a symmetric K: the eigenvalues of M
/// against K + shift M with the least shift >= 0 that makes it definite, so that the
/// smallest are as accurate as K is, however stiff the rest (stretching, shear). Of
/// others: real parts of the eigenvalues of M^-1 K. `typical`: sizes of the unknowns.
std::vector<double> small_motions(const Eigen::MatrixXd& mass,
                                  const Eigen::MatrixXd& stiffness,
                                  const Eigen::MatrixXd& constraints, In typical);

}  // namespace tress
