#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "contract/basics.h"

namespace tress {

/// Largest difference of two entries; infinite unless all are finite.
inline double apart(In x, In y) {
  double most = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i] - y[i])) return std::numeric_limits<double>::infinity();
    most = std::max(most, std::abs(x[i] - y[i]));
  }
  return most;
}

}  // namespace tress
