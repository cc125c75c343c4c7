#include "models/contact/box_pairs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tress::models {
namespace {

// Cell size over the mean of the boxes' longest sides: smaller cells list boxes more
// often, larger ones hold more that are far from each other: 10 000 pieces of shaken hair
// take 20 ms with 0.6, 15 with 1 and 14 with 1.5 (two threads).
constexpr double coarse = 1.5;

// A box reaches into so many cells along an axis at most: one stretched far by a failing
// run enlarges the cells and slows the search, but does not exhaust memory.
constexpr double longest = 16;

constexpr std::size_t group = 64;            // of buckets that one thread takes at a time
constexpr std::size_t placed_at_once = 512;  // boxes, by one thread

double longest_side(const Box& box) {
  const Vec side = box.most - box.least;
  return std::max({side.x, side.y, side.z});
}

bool finite(const Box& box) { return is_finite(box.least) && is_finite(box.most); }

// Outward, so that what overlaps does so in single precision.
float below(double x) {
  const auto rounded = static_cast<float>(x);
  return rounded <= x ? rounded
                      : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}
float above(double x) { return -below(-x); }

}  // namespace

void Box::grow(double by) {
  least = least - Vec{by, by, by};
  most = most + Vec{by, by, by};
}

BoxPairs::Cell BoxPairs::cell(const Vec& x) const {
  const auto index = [this](double at) {
    return static_cast<int>(std::clamp(std::floor(at * inverse_cell_), -1e9, 1e9));
  };
  return {index(x.x), index(x.y), index(x.z)};
}

std::size_t BoxPairs::bucket(const Cell& c) const {
  const std::uint64_t h = static_cast<std::uint64_t>(c.x) * 0x9E3779B97F4A7C15u ^
                          static_cast<std::uint64_t>(c.y) * 0xC2B2AE3D27D4EB4Fu ^
                          static_cast<std::uint64_t>(c.z) * 0x165667B19E3779F9u;
  return static_cast<std::size_t>(h >> 32) & mask_;
}

BoxPairs::Placed BoxPairs::place(const Box& box) const {
  if (!finite(box)) return {{}, {}, {0, 0, 0}, {-1, -1, -1}};
  return {{below(box.least.x), below(box.least.y), below(box.least.z)},
          {above(box.most.x), above(box.most.y), above(box.most.z)},
          cell(box.least),
          cell(box.most)};
}

template <class F>
void BoxPairs::each_cell(const Placed& box, F act) const {
  for (int x = box.from.x; x <= box.to.x; ++x) {
    for (int y = box.from.y; y <= box.to.y; ++y) {
      for (int z = box.from.z; z <= box.to.z; ++z) act(bucket({x, y, z}));
    }
  }
}

void BoxPairs::fill(std::span<const Box> boxes, const Loop& loop) {
  double sum = 0, most = 0;
  for (const Box& box : boxes) {
    if (!finite(box)) continue;
    sum += longest_side(box);
    most = std::max(most, longest_side(box));
  }
  inverse_cell_ = 1 / std::max({coarse * sum / static_cast<double>(boxes.size()),
                                most / longest, 1e-100});
  placed_.resize(boxes.size());
  loop((boxes.size() + placed_at_once - 1) / placed_at_once, [&](std::size_t g) {
    const std::size_t end = std::min(boxes.size(), (g + 1) * placed_at_once);
    for (std::size_t i = g * placed_at_once; i < end; ++i) placed_[i] = place(boxes[i]);
  });
  const std::size_t buckets = std::bit_ceil(std::max(group, boxes.size()));
  mask_ = buckets - 1;
  // Counting sort by bucket; counts stand two places later, so that starts move into
  // place.
  start_.assign(buckets + 2, 0);
  for (const Placed& box : placed_) {
    each_cell(box, [&](std::size_t b) { ++start_[b + 2]; });
  }
  for (std::size_t b = 2; b < start_.size(); ++b) start_[b] += start_[b - 1];
  boxes_.resize(start_.back());
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    each_cell(placed_[i],
              [&](std::size_t b) { boxes_[start_[b + 1]++] = static_cast<int>(i); });
  }
}

void BoxPairs::search(std::size_t b, Group& to) const {
  if (start_[b + 1] - start_[b] < 2) return;
  to.box.clear();
  for (std::size_t k = start_[b]; k < start_[b + 1]; ++k) {
    // Two cells of a box may share a bucket; its entries follow each other.
    if (to.box.empty() || to.box.back() != boxes_[k]) to.box.push_back(boxes_[k]);
  }
  const std::size_t n = to.box.size();
  const auto placed = [&](std::size_t i) -> const Placed& {
    return placed_[static_cast<std::size_t>(to.box[i])];
  };
  for (std::size_t d = 0; d < 3; ++d) {
    to.least[d].resize(n);
    to.most[d].resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      to.least[d][i] = placed(i).least[d];
      to.most[d][i] = placed(i).most[d];
    }
  }
  to.overlaps.resize(n);
  to.others.resize(n);
  const float *x0 = to.least[0].data(), *x1 = to.most[0].data(), *y0 = to.least[1].data(),
              *y1 = to.most[1].data(), *z0 = to.least[2].data(), *z1 = to.most[2].data();
  int *const overlaps = to.overlaps.data(), *const others = to.others.data();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const float ax0 = x0[i], ax1 = x1[i], ay0 = y0[i], ay1 = y1[i], az0 = z0[i],
                az1 = z1[i];
    for (std::size_t j = i + 1; j < n; ++j) {
      overlaps[j] = static_cast<int>(ax0 <= x1[j]) & static_cast<int>(x0[j] <= ax1) &
                    static_cast<int>(ay0 <= y1[j]) & static_cast<int>(y0[j] <= ay1) &
                    static_cast<int>(az0 <= z1[j]) & static_cast<int>(z0[j] <= az1);
    }
    // Without a branch, which nobody could foresee.
    std::size_t met = 0;
    for (std::size_t j = i + 1; j < n; ++j) {
      others[met] = static_cast<int>(j);
      met += static_cast<std::size_t>(overlaps[j]);
    }
    for (std::size_t k = 0; k < met; ++k) {
      const auto j = static_cast<std::size_t>(others[k]);
      // A pair counts in one of its cells: that of the least corner of its common part.
      const Cell &a = placed(i).from, &c = placed(j).from;
      const Cell corner{std::max(a.x, c.x), std::max(a.y, c.y), std::max(a.z, c.z)};
      if (bucket(corner) == b) to.found.push_back({to.box[i], to.box[j]});
    }
  }
}

const std::vector<BoxPairs::Pair>& BoxPairs::find(
    std::span<const Box> boxes, const Loop& loop,
    const std::function<void(std::vector<Pair>&)>& sift) {
  fill(boxes, loop);
  groups_.resize((mask_ + 1) / group);
  loop(groups_.size(), [&](std::size_t g) {
    groups_[g].found.clear();
    for (std::size_t b = g * group; b < (g + 1) * group; ++b) search(b, groups_[g]);
    sift(groups_[g].found);
  });
  pairs_.clear();
  for (const Group& some : groups_) {
    pairs_.insert(pairs_.end(), some.found.begin(), some.found.end());
  }
  return pairs_;
}

}  // namespace tress::models
