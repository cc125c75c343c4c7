#include "linear/block_matrix.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "linear/sparse_pattern.h"

namespace tress {

Pattern identity_pattern(int n) {
  Pattern pattern;
  pattern.rows = n;
  pattern.cols = n;
  pattern.start.resize(static_cast<std::size_t>(n) + 1);
  pattern.row.resize(static_cast<std::size_t>(n));
  std::iota(pattern.start.begin(), pattern.start.end(), 0);
  std::iota(pattern.row.begin(), pattern.row.end(), 0);
  return pattern;
}

BlockMatrix::BlockMatrix(int rows, int cols) {
  pattern_.rows = rows;
  pattern_.cols = cols;
}

int BlockMatrix::add_block(const Pattern& block, int row0, int col0, bool transposed) {
  const int height = transposed ? block.cols : block.rows;
  const int width = transposed ? block.rows : block.cols;
  if (row0 < 0 || col0 < 0 || row0 + height > pattern_.rows ||
      col0 + width > pattern_.cols) {
    throw std::invalid_argument("block matrix: a block sticks out of the matrix");
  }
  std::vector<Entry>& entries = entries_.emplace_back();
  entries.reserve(static_cast<std::size_t>(block.nonzeros()));
  for (int j = 0; j < block.cols; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int p = block.start[column]; p < block.start[column + 1]; ++p) {
      const int i = block.row[static_cast<std::size_t>(p)];
      entries.push_back(transposed ? Entry{row0 + j, col0 + i}
                                   : Entry{row0 + i, col0 + j});
    }
  }
  return static_cast<int>(entries_.size()) - 1;
}

void BlockMatrix::finish() {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(pattern_.cols));
  for (const auto& entries : entries_) {
    for (const Entry& e : entries)
      columns[static_cast<std::size_t>(e.col)].push_back(e.row);
  }
  pattern_ = pattern_of(pattern_.rows, std::move(columns));
  slot_.clear();
  for (const auto& entries : entries_) {
    std::vector<std::size_t>& slot = slot_.emplace_back();
    slot.reserve(entries.size());
    for (const Entry& e : entries) {
      slot.push_back(static_cast<std::size_t>(place_of(pattern_, e.row, e.col)));
    }
  }
  entries_.clear();
  entries_.shrink_to_fit();
  values_.assign(pattern_.row.size(), 0.0);
}

void BlockMatrix::clear() noexcept { std::ranges::fill(values_, 0.0); }

void BlockMatrix::add(int block, double factor, In values) noexcept {
  const std::vector<std::size_t>& slot = slot_[static_cast<std::size_t>(block)];
  for (std::size_t p = 0; p < slot.size(); ++p) values_[slot[p]] += factor * values[p];
}

}  // namespace tress
