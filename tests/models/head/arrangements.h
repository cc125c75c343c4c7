#pragma once

#include <cstddef>
#include <vector>

#include "models/head/head.h"

namespace tress::testing_support {

/// One of the ways to step the same strands, which must not show in their bits.
struct Arrangement {
  models::HeadPack pack;
  std::size_t together = 100;  // blocks in one call
};

/// Every number of lanes, of which the longest has other instructions where there are
/// more, and two of them by few blocks in a call.
inline std::vector<Arrangement> arrangements() {
  using enum models::HeadNumber;
  return {{{float64, 1}},
          {{float64, 4}},
          {{float64, 8}},
          {{float64, 4}, 1},
          {{float64, 1}, 2}};
}

}  // namespace tress::testing_support
