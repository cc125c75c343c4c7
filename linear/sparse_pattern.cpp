#include "linear/sparse_pattern.h"

#include <algorithm>

namespace tress {

Pattern pattern_of(int rows, std::vector<std::vector<int>> columns) {
  Pattern pattern;
  pattern.rows = rows;
  pattern.cols = static_cast<int>(columns.size());
  pattern.start = {0};
  for (std::vector<int>& entries : columns) {
    std::ranges::sort(entries);
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
    pattern.row.insert(pattern.row.end(), entries.begin(), entries.end());
    pattern.start.push_back(static_cast<int>(pattern.row.size()));
  }
  return pattern;
}

int place_of(const Pattern& pattern, int row, int column) {
  const auto j = static_cast<std::size_t>(column);
  const auto first = pattern.row.begin() + pattern.start[j];
  const auto last = pattern.row.begin() + pattern.start[j + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - pattern.row.begin());
}

void to_dense(const Pattern& pattern, In values, Out all) {
  std::ranges::fill(all, 0.0);
  const auto rows = static_cast<std::size_t>(pattern.rows);
  for (std::size_t j = 0; j < static_cast<std::size_t>(pattern.cols); ++j) {
    for (int k = pattern.start[j]; k < pattern.start[j + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      all[rows * j + static_cast<std::size_t>(pattern.row[at])] = values[at];
    }
  }
}

}  // namespace tress
