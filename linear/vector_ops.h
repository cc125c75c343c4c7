#pragma once

#include <cstddef>

#include "contract/basics.h"

namespace tress {

/// y += factor x
inline void add(InOut y, double factor, In x) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * x[i];
}

/// y = x + factor d
inline void shifted(Out y, In x, double factor, In d) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = x[i] + factor * d[i];
}

}  // namespace tress
