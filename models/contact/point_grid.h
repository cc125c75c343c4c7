#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "contract/basics.h"
#include "models/contact/box_pairs.h"

namespace tress::models {

/// Search for points in a box. A uniform grid with its cells in a hash table [Teschner et
/// al. 2003]. Filling is O(points), a query O(cells that the box overlaps, and points in
/// them).
class PointGrid {
 public:
  /// x: 3 numbers each, m; `cell`: about the size of the boxes, m, > 0. Points that are
  /// not finite are in no box.
  void fill(In x, double cell);
  /// Calls found(point) for every point in the box, each once, in an order that the
  /// points and the box decide.
  template <class F>
  void each_in(const Box& box, F found) const;

 private:
  struct Entry {
    Vec x;
    int point;
    std::int64_t cell[3];
  };
  std::int64_t cell(double at) const {
    constexpr double end = 1e15;
    const double floor = std::floor(at * inverse_cell_);
    return static_cast<std::int64_t>(floor > -end ? floor < end ? floor : end : -end);
  }
  std::size_t bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15u ^
                            static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Fu ^
                            static_cast<std::uint64_t>(z) * 0x165667B19E3779F9u;
    return static_cast<std::size_t>(h >> 32) & mask_;
  }

  double inverse_cell_ = 0;
  std::size_t mask_ = 0;            // number of buckets (a power of two) - 1
  std::vector<std::size_t> start_;  // of bucket b: entries_[start_[b], start_[b + 1])
  std::vector<Entry> entries_;
};

template <class F>
void PointGrid::each_in(const Box& box, F found) const {
  if (entries_.empty()) return;
  const auto inside = [&box](const Vec& x) {
    return x.x >= box.least.x && x.x <= box.most.x && x.y >= box.least.y &&
           x.y <= box.most.y && x.z >= box.least.z && x.z <= box.most.z;
  };
  // A box of more cells than points, as of a failing run, asks each point instead.
  const Vec side = box.most - box.least;
  const double cells = (side.x * inverse_cell_ + 1) * (side.y * inverse_cell_ + 1) *
                       (side.z * inverse_cell_ + 1);
  if (!(cells < static_cast<double>(entries_.size()) + 64)) {
    for (const Entry& entry : entries_) {
      if (inside(entry.x)) found(entry.point);
    }
    return;
  }
  for (std::int64_t i = cell(box.least.x); i <= cell(box.most.x); ++i) {
    for (std::int64_t j = cell(box.least.y); j <= cell(box.most.y); ++j) {
      for (std::int64_t k = cell(box.least.z); k <= cell(box.most.z); ++k) {
        const std::size_t b = bucket(i, j, k);
        for (std::size_t e = start_[b]; e < start_[b + 1]; ++e) {
          const Entry& entry = entries_[e];
          const bool here =
              entry.cell[0] == i && entry.cell[1] == j && entry.cell[2] == k;
          if (here && inside(entry.x)) found(entry.point);
        }
      }
    }
  }
}

}  // namespace tress::models
