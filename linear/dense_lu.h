#pragma once

#include <Eigen/LU>

namespace tress {

/// Dense LU with partial pivoting, 2/3 n^3 operations, compiled once. Eigen's blocked
/// kernel allocates packing buffers of its own from some 500 unknowns on; below, nothing
/// allocates after construction.
class DenseLu {
 public:
  explicit DenseLu(Eigen::Index size) : lu_(size), permuted_(size) {}

  /// Returns the smallest magnitude of a pivot; 1 where there are no unknowns.
  double factor(const Eigen::MatrixXd& a) noexcept;
  void solve(Eigen::Ref<Eigen::VectorXd> b) const noexcept;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  mutable Eigen::VectorXd permuted_;  // in place the permutation would allocate
};

}  // namespace tress
