#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "models/head/head.h"

namespace tress::models {

/// FNV-1a, by numbers, of the states of strands.
class StateHash {
 public:
  /// More strands, by what the head keeps of them.
  void add(const Head& head, std::span<const double> kept);
  /// Returns the hash of all strands so far.
  std::size_t value() const { return all_; }

 private:
  std::size_t all_ = 1469598103934665603U;
};

}  // namespace tress::models
