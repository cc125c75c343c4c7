#pragma once

#include "models/system.h"

namespace tress {

/// Neither nan nor infinite; 0 * inf and 0 * nan are nan.
inline bool all_finite(In values) noexcept {
  double zero = 0;
  for (double x : values) zero += 0 * x;
  return zero == 0;
}

}  // namespace tress
