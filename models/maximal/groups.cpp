#include "models/maximal/groups.h"

#include "linear/sparse_pattern.h"

namespace tress::models {

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
        const bool dropped = row < held_ || column < held_;
        place_.push_back(dropped ? -1 : place_of(pattern, row - held_, column - held_));
      }
    }
  }
}

}  // namespace tress::models
