#pragma once

#include <Eigen/Core>

namespace tress {

/// Of a general square matrix, in no order. In a file of its own: Eigen's iteration takes
/// long to compile.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace tress
