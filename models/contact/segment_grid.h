#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "contract/system.h"
#include "math/closest.h"

namespace tress::models {

/// Broad phase: which segments of many polylines may lie within `reach` of a point. A
/// uniform grid with its cells in a hash table [Teschner et al. 2003]; a segment is
/// listed in every cell that it can come within `reach` of. Temporal coherence [Bertails
/// et al. 2006, section 4.1]: the cells include a margin of half the reach and remain
/// valid until some point may have moved that far since they were filled. Memory and
/// filling are O(segments) for segments of similar length.
class SegmentGrid {
 public:
  /// points[k] >= 2: number of points of polyline k; reach > 0, m.
  SegmentGrid(std::span<const int> points, double reach);

  /// Takes the positions of all points (3 each), polyline after polyline. near() also
  /// holds while points are up to `range` (m) away from them; piece() does not follow.
  void update(In x, double range = 0);

  std::size_t segments() const { return pieces_.size(); }
  const StraightPiece& piece(int segment) const {
    return pieces_[static_cast<std::size_t>(segment)];
  }
  /// First of a segment's two points, among all points.
  int point(int segment) const {
    return segment + polyline_[static_cast<std::size_t>(segment)];
  }
  int polyline(int segment) const { return polyline_[static_cast<std::size_t>(segment)]; }

  struct Entry {
    int polyline, segment;
  };
  /// Every segment within reach of x and some others, ascending; some appear
  /// twice if a bucket holds two cells.
  std::span<const Entry> near(const Vec& x) const noexcept {
    const std::size_t b = bucket(cell(x));
    return {entries_.data() + start_[b], entries_.data() + start_[b + 1]};
  }

  long fillings() const { return fillings_; }
  /// Number of entries of segments in cells.
  std::size_t entries() const { return entries_.size(); }

 private:
  struct Cell {
    int x, y, z;
  };
  struct Mark {
    unsigned bucket;
    int segment;
  };
  Cell cell(const Vec& x) const noexcept;
  /// Cells in a row along z get consecutive buckets, neighbours in memory.
  unsigned bucket(const Cell& c) const noexcept {
    const std::uint64_t h = static_cast<std::uint64_t>(c.x) * 0x9E3779B97F4A7C15u ^
                            static_cast<std::uint64_t>(c.y) * 0xC2B2AE3D27D4EB4Fu;
    return (static_cast<unsigned>(h >> 32) + static_cast<unsigned>(c.z)) & mask_;
  }
  bool stands(In x, double range) const noexcept;
  void fill(In x, double range);
  void mark(const StraightPiece& piece, int segment);

  double reach_;
  std::vector<int> polyline_;          // of each segment
  std::vector<StraightPiece> pieces_;  // at the current positions
  std::vector<double> filled_;         // positions when the cells were filled
  double room_ = 0;                    // how far points may be from there, m
  double cell_ = 0, inverse_cell_ = 0;
  unsigned mask_ = 0;  // number of buckets (a power of two) - 1
  std::vector<Mark> marks_;
  std::vector<int> last_;   // per bucket: last marked segment of several parts
  std::vector<int> start_;  // of bucket b: entries_[start_[b], start_[b + 1])
  std::vector<Entry> entries_;
  long fillings_ = 0;
};

inline SegmentGrid::Cell SegmentGrid::cell(const Vec& x) const noexcept {
  const auto index = [this](double coordinate) {
    const double at = std::floor(coordinate * inverse_cell_);
    // Written so that NaN also maps to the end.
    constexpr double end = 1e9;
    return static_cast<int>(at > -end ? at < end ? at : end : -end);
  };
  return {index(x.x), index(x.y), index(x.z)};
}

}  // namespace tress::models
