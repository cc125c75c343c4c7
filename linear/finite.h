#pragma once

#include <cstddef>

#include "contract/basics.h"

namespace tress {

/// Whether all values are finite; 0 * inf and 0 * nan are nan. The sums are independent,
/// so that no addition waits for the one before.
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
