#pragma once

#include <span>
#include <vector>

#include "contract/basics.h"

namespace tress {

/// Symmetric matrix whose row i is zero before column first[i]. Rows of the lower
/// triangle are stored from there to the diagonal. The factor L of A = L L^T has the same
/// profile. Takes n k^2/2 multiply-adds for half-bandwidth k. [George 1981] A. George, J.
/// Liu, Computer Solution of Large Sparse Positive Definite Systems, ch. 4.
class Skyline {
 public:
  /// first[i] <= i.
  explicit Skyline(const std::vector<std::size_t>& first);

  /// Returns the number of rows.
  std::size_t size() const { return first_.size(); }
  /// Sets all entries to 0.
  void clear();
  /// Entry (i, j), first[i] <= j <= i.
  double& at(std::size_t i, std::size_t j) { return value_[start_[i] + j - first_[i]]; }
  /// += a matrix of the same profile.
  void add(const Skyline& other);

  /// Replaces the matrix by L. False: it is not positive definite to working precision,
  /// and what is held is of no use.
  bool factor() noexcept;
  /// b <- (L L^T)^-1 b.
  void solve(InOut b) const noexcept;

 private:
  std::vector<std::size_t> first_, start_;
  std::vector<double> value_;
};

}  // namespace tress
