#include "models/maximal/groups.h"

#include <algorithm>

namespace tress {

Groups::Groups(const std::vector<std::vector<int>>& groups, int held) : held_(held) {
  for (const std::vector<int>& group : groups) {
    coordinate_.insert(coordinate_.end(), group.begin(), group.end());
    start_.push_back(coordinate_.size());
  }
}

void Groups::couple(std::vector<std::vector<int>>& columns) const {
  for (std::size_t g = 0; g < count(); ++g) {
    for (const int column : coordinates(g)) {
      if (column < held_) continue;
      for (const int row : coordinates(g)) {
        if (row >= held_) {
          columns[static_cast<std::size_t>(column - held_)].push_back(row - held_);
        }
      }
    }
  }
}

void Groups::bind(const Pattern& pattern) {
  for (std::size_t g = 0; g < count(); ++g) {
    first_place_.push_back(place_.size());
    for (const int row : coordinates(g)) {
      for (const int column : coordinates(g)) {
        if (row < held_ || column < held_) {
          place_.push_back(-1);
          continue;
        }
        const auto c = static_cast<std::size_t>(column - held_);
        const auto begin = pattern.row.begin() + pattern.start[c];
        const auto end = pattern.row.begin() + pattern.start[c + 1];
        place_.push_back(static_cast<int>(std::lower_bound(begin, end, row - held_) -
                                          pattern.row.begin()));
      }
    }
  }
}

Pattern pattern_of(std::vector<std::vector<int>> columns) {
  Pattern pattern;
  pattern.rows = pattern.cols = static_cast<int>(columns.size());
  pattern.start = {0};
  for (std::vector<int>& rows : columns) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    pattern.row.insert(pattern.row.end(), rows.begin(), rows.end());
    pattern.start.push_back(static_cast<int>(pattern.row.size()));
  }
  return pattern;
}

}  // namespace tress
