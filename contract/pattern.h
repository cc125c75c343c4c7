#pragma once

#include <vector>

namespace tress {

/// Structure of a sparse matrix in compressed columns; rows ascend inside a column.
struct Pattern {
  int rows = 0;            // number of rows
  int cols = 0;            // number of columns
  std::vector<int> start;  // (cols + 1)
  std::vector<int> row;    // (start[cols])

  /// Returns the number of stored entries.
  int nonzeros() const { return start.empty() ? 0 : start.back(); }
};

}  // namespace tress
