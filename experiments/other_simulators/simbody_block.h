#pragma once

namespace tress::experiments::other_simulators {

/// Scene Slope in Simbody, whose headers of contact are not of C++20 (their comparisons
/// are ambiguous there): neither is this one. mm, mg and s.
struct SimbodyBlock {
  double gravity[3], half[3], moments[3];
  double mass, friction, settling, watched;

  double way(double dt) const;  // along x while it is watched
};

}  // namespace tress::experiments::other_simulators
