#pragma once

#include <cstddef>
#include <vector>

#include "math/instructions.h"
#include "models/head/head.h"

namespace tress::testing_support {

/// One of the ways to step the same strands, which must not show in their bits.
struct Arrangement {
  models::HeadPack pack;
  std::size_t together = 100;  // blocks in one call
};

/// Every number of lanes by every set of instructions that there is, and two of them by
/// few blocks in a call.
inline std::vector<Arrangement> arrangements() {
  std::vector<Arrangement> all;
  for (const int lanes : {1, 4, 8}) {
    for (const Instructions set : {Instructions::base, Instructions::avx512}) {
      if (available(set)) all.push_back({{models::HeadNumber::float64, lanes, set}});
    }
  }
  all.push_back({{models::HeadNumber::float64, 4, Instructions::base}, 1});
  all.push_back({{models::HeadNumber::float64, 1, Instructions::base}, 2});
  return all;
}

}  // namespace tress::testing_support
