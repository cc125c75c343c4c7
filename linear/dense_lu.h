#pragma once

#include <Eigen/LU>

namespace tress {

/// Dense LU with partial pivoting, 2/3 n^3 operations, compiled once. From about 500
/// unknowns, Eigen's blocked kernel allocates its own packing buffers; below, nothing
/// allocates after construction.
class DenseLu {
 public:
  /// Allocates for a matrix (size x size).
  explicit DenseLu(Eigen::Index size) : lu_(size), permuted_(size) {}

  /// Returns the smallest magnitude of a pivot; 1 if there are no unknowns.
  double factor(const Eigen::MatrixXd& a) noexcept;
  /// Solves A x = b with the last factors; b becomes x.
  void solve(Eigen::Ref<Eigen::VectorXd> b) const noexcept;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  mutable Eigen::VectorXd permuted_;  // permuting in place would allocate
};

}  // namespace tress
