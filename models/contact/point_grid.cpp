#include "models/contact/point_grid.h"

#include <algorithm>
#include <bit>

namespace tress::models {

void PointGrid::fill(In x, double cell_size) {
  inverse_cell_ = 1 / cell_size;
  const std::size_t count = x.size() / 3;
  mask_ = std::bit_ceil(std::max<std::size_t>(count, 1)) - 1;
  std::vector<Entry> all;
  all.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec at = load3(&x[3 * i]);
    if (!is_finite(at)) continue;
    all.push_back({at, static_cast<int>(i), {cell(at.x), cell(at.y), cell(at.z)}});
  }
  const auto bucket_of = [this](const Entry& entry) {
    return bucket(entry.cell[0], entry.cell[1], entry.cell[2]);
  };
  // Counting sort; counts stand two places later, so that starts move into place.
  start_.assign(mask_ + 3, 0);
  for (const Entry& entry : all) ++start_[bucket_of(entry) + 2];
  for (std::size_t b = 2; b < start_.size(); ++b) start_[b] += start_[b - 1];
  entries_.resize(all.size());
  for (const Entry& entry : all) entries_[start_[bucket_of(entry) + 1]++] = entry;
}

}  // namespace tress::models
