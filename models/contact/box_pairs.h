#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "math/vec3.h"

namespace tress::models {

/// Calls work(i) once for every i < count, on any threads.
using Loop =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

/// Sides along the axes, m.
struct Box {
  Vec least, most;  // corners, m

  /// Holds no place; what it includes decides.
  static constexpr Box none() {
    constexpr double end = std::numeric_limits<double>::infinity();
    return {{end, end, end}, {-end, -end, -end}};
  }
  /// Tests for none(), or a box that is not finite.
  bool empty() const { return !(least.x <= most.x); }

  /// Grows the box to hold a place.
  void include(const Vec& x) { include(Box{x, x}); }
  /// Grows the box to hold another one.
  void include(const Box& other) {
    const Vec &a = other.least, &b = other.most;
    least = {std::min(least.x, a.x), std::min(least.y, a.y), std::min(least.z, a.z)};
    most = {std::max(most.x, b.x), std::max(most.y, b.y), std::max(most.z, b.z)};
  }
  /// Moves all sides outwards, m.
  void grow(double by);
};
/// Returns true if no place is in both boxes.
inline bool apart(const Box& a, const Box& b) {
  return a.least.x > b.most.x || b.least.x > a.most.x || a.least.y > b.most.y ||
         b.least.y > a.most.y || a.least.z > b.most.z || b.least.z > a.most.z;
}

/// Broad phase of many boxes of similar size: finds the boxes that overlap. A box is
/// listed in every cell of a uniform grid that it overlaps and tested against the others
/// there. Cells are in a hash table [Teschner et al. 2003]. Every search rebuilds the
/// table, which takes about 0.5 us per box on shaken hair.
class BoxPairs {
 public:
  /// Two boxes that may touch.
  struct Pair {
    int first, second;    // the first before the second
    double distance = 0;  // that they keep at least, m, if it is told
  };

  /// Finds every pair of boxes that overlap, each once, in an order that depends on the
  /// boxes only. The caller's sift(pairs) removes pairs and may record the distances of
  /// the others. Several threads call it at once. Boxes that are not finite overlap with
  /// none.
  const std::vector<Pair>& find(std::span<const Box> boxes, const Loop& loop,
                                const std::function<void(std::vector<Pair>&)>& sift);

 private:
  struct Cell {
    int x, y, z;
  };
  /// Data of a box to compare, and the cells that it overlaps; none if it is not finite.
  struct Placed {
    float least[3], most[3];
    Cell from, to;
  };
  /// Some buckets, which one thread searches at a time. Boxes of one of them, number by
  /// number, for comparisons of many at once.
  struct Group {
    std::vector<float> least[3], most[3];
    std::vector<int> box, overlaps, others;
    std::vector<Pair> found;
  };
  Cell cell(const Vec& x) const;
  std::size_t bucket(const Cell& c) const;
  Placed place(const Box& box) const;
  template <class F>
  void each_cell(const Placed& box, F act) const;
  void fill(std::span<const Box> boxes, const Loop& loop);
  void search(std::size_t bucket, Group& to) const;

  double inverse_cell_ = 0;
  std::size_t mask_ = 0;            // number of buckets (a power of two) - 1
  std::vector<std::size_t> start_;  // of bucket b: boxes_[start_[b], start_[b + 1])
  std::vector<int> boxes_;
  std::vector<Placed> placed_;  // boxes
  std::vector<Group> groups_;
  std::vector<Pair> pairs_;
};

}  // namespace tress::models
