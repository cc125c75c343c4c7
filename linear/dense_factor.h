#pragma once

#include <Eigen/Cholesky>

#include "contract/basics.h"
#include "linear/dense_lu.h"

namespace tress {

/// A dense matrix of mixed units, scaled to unit diagonal and factored: Cholesky when it
/// is symmetric, LU otherwise. `matrix` is written by the caller and destroyed by
/// factor().
class DenseFactor {
 public:
  /// Allocates a matrix (size x size).
  DenseFactor(int size, bool symmetric);
  /// Factors `matrix`; `retry` if it is singular or not finite.
  Status factor() noexcept;
  Status solve(In b, Out x) noexcept;  // b and x may be the same

  Eigen::MatrixXd matrix;  // matrix to be factored, (size x size)

 private:
  bool symmetric_;
  Eigen::VectorXd rhs_, scale_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
  DenseLu lu_;
};

/// c += a b, of any size.
void add_dense_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                       Eigen::MatrixXd& c);

}  // namespace tress
