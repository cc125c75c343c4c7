#pragma once

#include <vector>

#include "contract/basics.h"

namespace tress {

/// Solves A x = b with a square A that need not be regular: x is the vector of least
/// norm among those that come nearest to b. Rows are scaled to a largest entry of 1.
class LeastNorm {
 public:
  /// Factors a matrix, by columns, whose entries have relative errors far below
  /// `dependence`. False: some entry is not finite.
  bool factor(In columns, std::size_t size);
  /// b becomes x.
  void solve(InOut b) const;

  /// Pivots below this part of the largest one count as none.
  static constexpr double dependence = 1e-8;

 private:
  std::vector<double> scale_, inverse_;  // of rows; by columns
};

}  // namespace tress
