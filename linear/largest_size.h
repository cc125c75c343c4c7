#pragma once

#include <algorithm>
#include <cmath>

#include "contract/basics.h"

namespace tress {

/// Returns the largest absolute value; 0 if there are none.
inline double largest_size(In x) {
  double most = 0;
  for (const double one : x) most = std::max(most, std::abs(one));
  return most;
}

}  // namespace tress
