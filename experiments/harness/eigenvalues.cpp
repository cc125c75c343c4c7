#include "experiments/harness/eigenvalues.h"

#include <Eigen/Eigenvalues>

namespace tress {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) {
  return matrix.eigenvalues();
}

}  // namespace tress
