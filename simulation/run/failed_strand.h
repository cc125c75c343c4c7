#pragma once

#include <cstddef>
#include <string>

namespace tress::simulation {

/// A strand that stays where it is from this time on.
struct FailedStrand {
  std::size_t strand;
  double t;  // s
  std::string reason;
};

}  // namespace tress::simulation
