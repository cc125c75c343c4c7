#pragma once

#include <span>
#include <vector>

#include "contract/basics.h"
#include "contract/pattern.h"
#include "math/pack.h"

namespace tress::models {

/// Maps square matrices over groups of coordinates to the entries of a sparse matrix of
/// symmetric pattern. Coordinates below `held` are prescribed; their rows and columns are
/// dropped.
class Groups {
 public:
  /// Takes the groups; coordinates below `held` are prescribed.
  Groups(const std::vector<std::vector<int>>& groups, int held);

  /// Adds every pair of a group to `columns`, one list of rows per unprescribed
  /// coordinate.
  void couple(std::vector<std::vector<int>>& columns) const;
  /// Looks up the indices of all entries; call once.
  void bind(const Pattern& pattern);

  /// Returns the number of coordinates of a group.
  std::size_t size(std::size_t group) const { return start_[group + 1] - start_[group]; }
  /// Returns the coordinates of a group.
  std::span<const int> coordinates(std::size_t group) const {
    return std::span(coordinate_).subspan(start_[group], size(group));
  }
  /// Indices of the entries of a group's matrix, row by row; -1: dropped.
  const int* places(std::size_t group) const { return &place_[first_place_[group]]; }
  /// Returns the number of groups.
  std::size_t count() const { return start_.size() - 1; }

 private:
  int held_;
  std::vector<std::size_t> start_{0};
  std::vector<int> coordinate_;
  std::vector<std::size_t> first_place_;
  std::vector<int> place_;
};

/// Adds matrices of groups to the values of a sparse matrix.
class GroupSum {
 public:
  /// Adds to `values`, the entries of the pattern given to bind().
  GroupSum(const Groups& groups, Out values) : groups_(groups), values_(values) {}
  /// `matrix` is (size x size), row-major.
  void add(std::size_t group, const double* matrix) {
    const std::size_t entries = groups_.size(group) * groups_.size(group);
    const int* place = groups_.places(group);
    for (std::size_t k = 0; k < entries; ++k) {
      if (place[k] >= 0) values_[static_cast<std::size_t>(place[k])] += matrix[k];
    }
  }
  /// Adds a matrix given as rows of packs, for a group with one coordinate fewer than
  /// rows. The last row and column are omitted.
  template <std::size_t rows, std::size_t packs>
  void add(std::size_t group, const Pack (&matrix)[rows][packs]) {
    constexpr std::size_t size = rows - 1;
    const int* place = groups_.places(group);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j, ++place) {
        if (*place < 0) continue;
        values_[static_cast<std::size_t>(*place)] +=
            matrix[i][j / Pack::lanes][static_cast<int>(j % Pack::lanes)];
      }
    }
  }

 private:
  const Groups& groups_;
  Out values_;
};

}  // namespace tress::models
