#pragma once

#include <vector>

#include "contract/basics.h"
#include "contract/pattern.h"

namespace tress {

/// Returns the pattern of the identity matrix (n x n).
Pattern identity_pattern(int n);

/// A sparse matrix assembled from blocks of fixed pattern, at any position, overlapping
/// or not: A = sum_b factor_b place_b(block_b or its transpose). Positions are computed
/// once in finish(); afterwards clear() and add() only write numbers, O(nonzeros of the
/// block).
class BlockMatrix {
 public:
  /// Starts a matrix without blocks (rows x cols).
  BlockMatrix(int rows, int cols);

  /// Adds a block with its upper left corner at (row0, col0); returns its id.
  /// `transposed`: values are given in the order of `block` and stored in its transpose.
  int add_block(const Pattern& block, int row0, int col0, bool transposed = false);
  /// Ends the list of blocks and computes the pattern.
  void finish();

  /// Returns the pattern of the sum; complete after finish().
  const Pattern& pattern() const { return pattern_; }
  /// Sets all entries to 0.
  void clear() noexcept;
  /// Adds `factor` times the block of this id, `values` in the order of the block's
  /// pattern.
  void add(int block, double factor, In values) noexcept;
  /// Returns the entries in the order of pattern().
  In values() const { return values_; }

 private:
  struct Entry {
    int row, col;
  };
  std::vector<std::vector<Entry>> entries_;     // per block, until finish()
  std::vector<std::vector<std::size_t>> slot_;  // per block: entry -> index in values_
  Pattern pattern_;
  std::vector<double> values_;
};

}  // namespace tress
