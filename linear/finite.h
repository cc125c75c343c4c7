#pragma once

#include <cstddef>

#include "contract/system.h"

namespace tress {

/// Neither nan nor infinite; 0 * inf and 0 * nan are nan. Sums side by side, so that none
/// waits for the one before.
inline bool all_finite(In values) noexcept {
  constexpr std::size_t lanes = 8;
  double zero[lanes] = {};
  const std::size_t whole = values.size() / lanes * lanes;
  for (std::size_t i = 0; i < whole; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) zero[k] += 0 * values[i + k];
  }
  for (const double x : values.subspan(whole)) zero[0] += 0 * x;
  double sum = 0;
  for (const double x : zero) sum += x;
  return sum == 0;
}

}  // namespace tress
