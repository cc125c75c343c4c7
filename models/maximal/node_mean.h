#pragma once

#include <array>

#include "contract/system.h"
#include "math/vec3.h"

namespace tress::models {

/// A point of the strand as the weighted mean of up to four consecutive nodes.
struct NodeMean {
  int first = 0;  // node
  int nodes = 1;
  std::array<double, 4> weight{1};

  Vec of(In values) const {  // (3 nodes)
    Vec sum;
    for (int k = 0; k < nodes; ++k) {
      sum = sum + weight[static_cast<std::size_t>(k)] *
                      load3(&values[3 * static_cast<std::size_t>(first + k)]);
    }
    return sum;
  }
};

}  // namespace tress::models
