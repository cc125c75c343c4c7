#include "simulation/head/cell_set.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace tress::simulation {

using models::Box;

CellSet::CellSet(const Vec& corner, double size, const Box& all)
    : corner_(corner), size_(size), box_(all) {
  if (all.empty()) return;
  all_ = cells(all);
  std::size_t count = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    count *= static_cast<std::size_t>(all_.to[i] - all_.from[i] + 1);
  }
  marks_.resize(count);
}

/// Of a box that may reach beyond all cells of the head.
CellSet::Range CellSet::cells(const Box& box) const {
  const auto index = [&](double at, double from) {
    return static_cast<long>(
        std::floor(std::clamp((at - from) / size_, -2.0, most_cells + 2)));
  };
  return {{index(box.least.x, corner_.x), index(box.least.y, corner_.y),
           index(box.least.z, corner_.z)},
          {index(box.most.x, corner_.x), index(box.most.y, corner_.y),
           index(box.most.z, corner_.z)}};
}

namespace {

/// Calls use(first, last) for the rows of cells of a range in a box of cells, until it
/// returns true; whether it has.
template <class Range, class Use>
bool each_row(const Range& all, Range some, Use use) {
  for (std::size_t i = 0; i < 3; ++i) {
    some.from[i] = std::max(some.from[i], all.from[i]);
    some.to[i] = std::min(some.to[i], all.to[i]);
  }
  const auto side = [&](std::size_t i) { return all.to[i] - all.from[i] + 1; };
  for (long z = some.from[2]; z <= some.to[2]; ++z) {
    for (long y = some.from[1]; y <= some.to[1]; ++y) {
      const long row =
          ((z - all.from[2]) * side(1) + (y - all.from[1])) * side(0) - all.from[0];
      if (some.from[0] <= some.to[0] && use(static_cast<std::size_t>(row + some.from[0]),
                                            static_cast<std::size_t>(row + some.to[0]))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

void CellSet::mark(const Box& box) {
  each_row(all_, cells(box), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i <= last; ++i) {
      std::atomic_ref(marks_[i]).store(1, std::memory_order_relaxed);
    }
    return false;
  });
}

bool CellSet::holds_some(const Box& box) const {
  return each_row(all_, cells(box), [&](std::size_t first, std::size_t last) {
    return std::find(marks_.begin() + static_cast<std::ptrdiff_t>(first),
                     marks_.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                     1) != marks_.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  });
}

}  // namespace tress::simulation
