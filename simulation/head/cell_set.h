#pragma once

#include <array>
#include <vector>

#include "models/contact/box_pairs.h"

namespace tress::simulation {

/// Cells of space that something lies in, as far as a box of them reaches. All such sets
/// of one corner and size of cells have the same cells, `most_cells` along a side at
/// most.
class CellSet {
 public:
  static constexpr double most_cells = 128;  // Bound of the cells along a side.

  CellSet() = default;
  /// `all`: what it may hold.
  CellSet(const Vec& corner, double size, const models::Box& all);

  /// Safe for several threads at once.
  void mark(const models::Box& box);
  /// Returns true if a marked cell touches the box.
  bool holds_some(const models::Box& box) const;

  /// Returns the box of all that the set may hold.
  const models::Box& all() const { return box_; }
  /// Returns the marks of all cells, to be exchanged between ranks.
  std::vector<char>& marks() { return marks_; }

 private:
  struct Range {
    std::array<long, 3> from, to;
  };
  Range cells(const models::Box& box) const;

  Vec corner_;
  double size_ = 1;
  models::Box box_ = models::Box::none();
  Range all_{{0, 0, 0}, {-1, -1, -1}};
  std::vector<char> marks_;
};

}  // namespace tress::simulation
