#pragma once

#include <vector>

#include "experiments/other_simulators/simulator.h"
#include "experiments/problems/strand_reference.h"

namespace tress::experiments::other_simulators {

constexpr double sample = 0.02;  // s between looks at the tip, and the largest step
constexpr int samples = 100;

using Track = std::vector<Vec>;  // of the tip seen from the clamp, every `sample`, mm

/// The rod that the links of scene `swing` stand for, by our own models. Computed in
/// about ten seconds.
class ContinuousRod {
 public:
  ContinuousRod();
  /// Root mean square distance of its tip from a track's, over the length.
  double distance(const Track& track) const;

 private:
  TipReference tip_;
};

}  // namespace tress::experiments::other_simulators
