#pragma once

#include <span>
#include <vector>

namespace tress {

/// LU with partial pivoting of a square band matrix, a(i, j) = 0 unless -lower <= j - i
/// <= upper. Allocates only in the constructor. Use: `clear`, fill, `factor`, `solve`.
/// Cost O(n lower (lower + upper)). Source: G. Golub, C. Van Loan, Matrix Computations
/// (4th ed.), section 4.3.5.
class BandedLu {
 public:
  /// Allocates a matrix (n x n) with this many diagonals below and above the main one.
  BandedLu(int n, int lower, int upper);

  /// Sets all entries to 0.
  void clear();
  double& at(int i, int j) { return band_[index(i, j)]; }  // (i, j) inside the band
  bool factor() noexcept;                          // false: singular or not finite
  void solve(std::span<double> x) const noexcept;  // b in, x out

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(j - i + lower_);
  }

  int n_, lower_, reach_, width_;  // reach: columns right of the diagonal, with fill
  std::vector<double> band_;       // (n x width) rows
  std::vector<int> pivot_;         // (n) row swapped with row k
};

}  // namespace tress
