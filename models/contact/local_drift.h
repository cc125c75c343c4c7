#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

#include "math/lane_choice.h"
#include "math/lanes.h"
#include "models/contact/box_pairs.h"
#include "models/contact/segment_cells.h"

namespace tress::models {

/// Relative displacements near a place in one step. Hair far away that moves fast does
/// not affect lists of nearby segments. A uniform grid; each cell stores a ball that
/// holds the displacements of all segments in it and in neighbouring cells. Memory is
/// O(segments); an empty cell takes one number. A step is O(segments).
class LocalDrift {
 public:
  /// Displacements, m; radius < 0: of nothing.
  struct Spread {
    Vec middle;     // mean displacement
    double radius;  // largest distance from the mean
  };

  /// Segments as they lie at x. A place is told of all parts of segments whose middles
  /// are no farther from it than `sight` (m) along each axis; not of long segments.
  void fill(const SegmentCells& segments, In x, double sight, const Loop& loop);
  /// The displacement of every point; one that is not finite is of no account. The result
  /// does not depend on who runs the loop's parts.
  void move(const SegmentCells& segments, std::span<const Vec> by, const Loop& loop);

  /// Returns the displacements of the step near this cell.
  const Spread& near(int cell) const {
    const int one = number_[static_cast<std::size_t>(cell)];
    return one < 0 ? nothing : near_[static_cast<std::size_t>(one)];
  }
  /// The cell of each lane's place at the time of fill(); of places that are not finite
  /// some cell.
  template <class P>
  std::array<int, lanes<P>> cells(const Vec3<P>& at) const noexcept;
  /// The radius, mean over all segments, m.
  double mean() const { return mean_; }

  /// Returns the memory in use, bytes.
  std::size_t bytes() const;

 private:
  static constexpr Spread nothing{{}, -1};

  void number_cells();
  /// Returns the distance from a cell to the next along an axis; axis 3: number of all
  /// cells.
  std::size_t stride(int axis) const;
  template <class Use>
  void each_beside(std::size_t cell, int axis, const Use& use) const;

  double inverse_side_ = 1;
  Vec corner_;
  int count_[3] = {1, 1, 1};
  // Of cells: which it is of those with something in it or beside it, or -1.
  std::vector<int> number_;
  // Of these.
  std::vector<int> cell_, parts_;
  std::vector<Box> own_;  // by pieces of work
  std::vector<Spread> near_;
  std::vector<int> of_part_;  // the same, of parts of segments
  double mean_ = 0;
};

template <class P>
std::array<int, lanes<P>> LocalDrift::cells(const Vec3<P>& at) const noexcept {
  using Ints __attribute__((vector_size(lanes<P> * sizeof(int)))) = int;
  const auto index = [this](const P& place, double corner, int count) {
    const P i = P(inverse_side_) * (place - P(corner)), last(count - 1), zero(0);
    return __builtin_convertvector(where_less(zero, i, smaller(i, last), zero).v, Ints);
  };
  const Ints row =
      index(at.z, corner_.z, count_[2]) * count_[1] + index(at.y, corner_.y, count_[1]);
  return std::bit_cast<std::array<int, lanes<P>>>(row * count_[0] +
                                                  index(at.x, corner_.x, count_[0]));
}

}  // namespace tress::models
