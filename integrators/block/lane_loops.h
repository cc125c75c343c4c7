#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "contract/block.h"

/// Loops over entries [k W + l] with numbers of each lane, and choices as math/
/// lane_choice.h makes them.
namespace tress::integrators {

/// use(i, lane) of all entries i of `count` numbers per lane. Of the usual widths the
/// compiler makes packs.
template <class Use>
void for_lanes(std::size_t count, int lanes, Use use) {
  const auto run = [&](auto width) {
    for (std::size_t k = 0; k < count; ++k) {
      for (int lane = 0; lane < width; ++lane) {
        use(k * static_cast<std::size_t>(width) + static_cast<std::size_t>(lane), lane);
      }
    }
  };
  switch (lanes) {
    case 1:
      return run(std::integral_constant<int, 1>{});
    case 4:
      return run(std::integral_constant<int, 4>{});
    case 8:
      return run(std::integral_constant<int, 8>{});
    case 16:
      return run(std::integral_constant<int, 16>{});
    default:
      return run(lanes);
  }
}

/// Returns true if the set contains the lane.
inline bool has(Lanes set, int lane) { return (set >> lane & 1U) != 0; }
/// Returns the set of the first `count` lanes.
inline Lanes all_lanes(int count) {
  return count >= 32 ? ~Lanes{0} : (Lanes{1} << count) - 1;
}

/// The first if one of them is NaN.
template <class N>
N larger_of(N x, N y) {
  return x < y ? y : x;
}

}  // namespace tress::integrators
