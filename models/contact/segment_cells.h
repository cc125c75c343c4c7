#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contract/basics.h"
#include "math/closest.h"
#include "models/contact/box_pairs.h"

namespace tress::models {

/// A Loop without threads.
inline void in_turn(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
}

/// Calls work(from, to) for parts of [0, count) of at most loop_part entries.
inline constexpr std::size_t loop_part = 8192;
/// Calls work(from, to) for parts of [0, count) of at most loop_part entries.
inline void in_parts(std::size_t count, const Loop& loop,
                     const std::function<void(std::size_t, std::size_t)>& work) {
  loop((count + loop_part - 1) / loop_part,
       [&](std::size_t i) { work(i * loop_part, std::min(count, (i + 1) * loop_part)); });
}

/// Broad phase: finds segments of many polylines that may come within a distance of a
/// given piece. A segment lies in the cell of its middle only; one much longer than usual
/// is divided into parts. Cells lie in rows of one uniform grid, one after the other in
/// memory, so that a search compares the boxes of few runs of consecutive cells. The grid
/// spans the region of most points; segments outside lie in the cells of its border. Long
/// segments, such as those of a run that fails, are candidates of every search. Memory
/// and filling are O(segments), up to 500 bytes per segment where the reach is short. A
/// search is O(parts nearby).
class SegmentCells {
 public:
  /// points[k] >= 2: number of points of polyline k.
  explicit SegmentCells(std::span<const int> points);

  /// Takes the positions of all points (3 each), polyline after polyline, for searches of
  /// about `reach` (m). The result does not depend on who runs the loop's parts.
  void fill(In x, double reach, const Loop& loop);

  /// Numbers of polylines, points and segments count over all. A segment is known by the
  /// number of its first point.
  std::size_t polylines() const { return first_.size() - 1; }
  /// Returns the number of points.
  std::size_t points() const { return polyline_.size(); }
  /// Returns the polyline of a point.
  int polyline(int point) const { return polyline_[static_cast<std::size_t>(point)]; }
  /// Returns the first point of a polyline.
  int first(std::size_t polyline) const { return first_[polyline]; }
  /// Returns true for the last point of its polyline.
  bool last(int point) const {
    return point + 1 == first_[static_cast<std::size_t>(polyline(point)) + 1];
  }

  /// Sets `found` to every segment of polylines other than `but` that comes within
  /// `radius` of the piece, and some others; ascending, each once.
  void near(const StraightPiece& piece, double radius, int but,
            std::vector<int>& found) const;
  /// Appends to `found` every segment that reaches into the box, and some others, own
  /// ones too, in some order, some more than once; but no long ones.
  void reaching_into(const Box& box, std::vector<int>& found) const;
  /// Returns the long segments in ascending order.
  std::span<const int> long_segments() const { return long_; }

  /// Returns the range [first, second) of a segment's parts; empty if it is long or not
  /// finite.
  std::pair<std::size_t, std::size_t> parts_of(std::size_t segment) const {
    return {static_cast<std::size_t>(part_[segment]),
            static_cast<std::size_t>(part_[segment + 1])};
  }
  /// Returns the number of parts of all segments.
  std::size_t parts() const { return static_cast<std::size_t>(part_.back()); }
  double longest_part() const { return longest_; }  // m
  /// Whether usual segments lie in several.
  bool divided() const { return divided_; }
  /// Returns the length of the longest part, for segments of `usual` length in searches
  /// of about `reach` (m).
  static double longest_part(double usual, double reach);
  /// Calls act(part, middle) at x, the places of fill().
  template <class F>
  void each_part(std::size_t segment, In x, F act) const {
    const auto [from, to] = parts_of(segment);
    if (from == to) return;
    const StraightPiece all(load3(&x[3 * segment]), load3(&x[3 * segment + 3]));
    const double share = 1 / static_cast<double>(to - from);
    for (std::size_t p = from; p < to; ++p) {
      act(p, all.at((static_cast<double>(p - from) + 0.5) * share));
    }
  }
  /// Returns the box that the grid spans.
  Box extent() const;

  /// Returns the memory in use, bytes.
  std::size_t bytes() const;

 private:
  using Numbers = std::array<int, 4>;  // along each axis, and one for nothing
  Numbers cell(const Vec& place) const noexcept;
  std::size_t row(int y, int z) const noexcept {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) +
            static_cast<std::size_t>(y)) *
           static_cast<std::size_t>(count_[0]);
  }
  /// Returns the grid steps of a place, about 2^16 across the grid along each axis.
  /// Monotonic in the place.
  Numbers steps(const Vec& place) const noexcept;
  /// Part of a segment with its box in steps: least, and most negated.
  struct alignas(16) Part {
    std::array<std::int16_t, 6> box;
    int segment;
  };
  Part part(In x, std::size_t segment, double from, double to) const noexcept;
  void choose_parts(In x, double reach);
  void choose_cells(In x, std::size_t parts);
  int number_of_parts(int segment, In x) const noexcept;
  void sort(In x, const Loop& loop);

  std::vector<int> polyline_;  // of each point
  std::vector<int> first_;     // point of each polyline, and the number of all
  double longest_ = 1;         // part, m
  bool divided_ = false;
  double cell_ = 1, inverse_cell_ = 1, steps_[3] = {1, 1, 1};  // a metre
  Vec corner_;
  int count_[3] = {1, 1, 1};
  // Parts of segment i are [part_[i], part_[i + 1]), none if it is long; their cells.
  std::vector<int> part_, cell_of_;
  // Sorted by cells, those of cell c are [start_[c], start_[c + 1]).
  std::vector<int> start_;
  std::vector<Part> parts_;
  std::vector<int> long_;
};

}  // namespace tress::models
