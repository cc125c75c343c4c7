#pragma once

#include <cstdint>
#include <random>

#include "contract/layers.h"

namespace tress::simulation {

/// Random numbers that are the same wherever they are drawn: the generator is that of the
/// C++ standard, whose distributions are left to each library.
class Random {
 public:
  /// One stream for each pair.
  Random(std::uint64_t seed, std::uint64_t stream);

  double uniform();  // in [0, 1), 53 bits
  double normal();   // mean 0, variance 1 (Box & Muller 1958)

 private:
  std::mt19937_64 bits_;
};

}  // namespace tress::simulation
