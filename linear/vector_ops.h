#pragma once

#include <cstddef>
#include <numeric>

#include "contract/basics.h"

namespace tress {

/// y += factor x
inline void add(InOut y, double factor, In x) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * x[i];
}

/// Returns the scalar product of two vectors of equal length.
inline double scalar_product(In x, In y) {
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
}

/// y = x + factor d
inline void shifted(Out y, In x, double factor, In d) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = x[i] + factor * d[i];
}

}  // namespace tress
