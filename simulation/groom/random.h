#pragma once

#include <cstdint>
#include <random>

#include "contract/layers.h"

namespace tress::simulation {

/// Random numbers that are identical on all platforms: the generator is that of the C++
/// standard; the standard's distributions depend on the library and are not used.
class Random {
 public:
  /// One stream per pair.
  Random(std::uint64_t seed, std::uint64_t stream);

  double uniform();  // in [0, 1), 53 bits
  double normal();   // mean 0, variance 1 (Box & Muller 1958)

 private:
  std::mt19937_64 bits_;
};

}  // namespace tress::simulation
