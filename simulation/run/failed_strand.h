#pragma once

#include <cstddef>
#include <string>

namespace tress::simulation {

/// A strand that stays where it is from this time on.
struct FailedStrand {
  std::size_t strand;  // index of the strand
  double t;            // s
  std::string reason;  // cause, for messages
};

}  // namespace tress::simulation
