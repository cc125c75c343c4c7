#pragma once

#include <string_view>
#include <vector>

#include "contract/pattern.h"
#include "linear/direct_solver.h"

namespace tress {

/// A symmetric reordering and the band it leaves.
struct BandOrdering {
  std::vector<int> position;  // (n) unknown -> position in the band
  int lower = 0;              // kl: largest distance of an entry below the diagonal
  int upper = 0;              // ku
};

/// Reverse Cuthill-McKee on the symmetrised pattern: breadth first by ascending degree
/// from a node at the end of a longest level structure, then reversed.
/// [George 1981] A. George, J. Liu, Computer Solution of Large Sparse Positive Definite
/// Systems, ch. 4. O(nonzeros log nonzeros).
BandOrdering reverse_cuthill_mckee(const Pattern& pattern);

/// Banded LU with partial pivoting in a reverse Cuthill-McKee ordering: n kl (kl + ku)
/// multiply-adds, n (2 kl + ku + 1) doubles. The KKT matrix of a chain has
/// half-bandwidth 4.
class BandedSolver final : public DirectSolver {
 public:
  /// Orders the unknowns by reverse_cuthill_mckee().
  explicit BandedSolver(const Pattern& pattern);
  /// Takes an ordering that is known.
  BandedSolver(const Pattern& pattern, BandOrdering ordering);
  std::string_view name() const override { return "banded"; }

 private:
  double factor_scaled(In values) noexcept override;
  void solve_scaled(InOut b) const noexcept override;

  double* diagonal(int column) noexcept;
  const double* diagonal(int column) const noexcept;

  BandOrdering ordering_;
  int n_;
  int stride_;                     // between columns: 2 kl + ku + 1
  std::vector<std::size_t> slot_;  // (nonzeros) entry -> index in band_
  std::vector<double> band_;       // columns; the top kl rows hold fill from pivoting
  std::vector<int> pivot_;         // (n) row swapped with row j, as an offset from j
  mutable std::vector<double> work_;
};

}  // namespace tress
