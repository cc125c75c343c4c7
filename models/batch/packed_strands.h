#pragma once

#include <span>
#include <vector>

#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Up to four strands, one in each lane; lanes without one hold the first again.
struct PackedStrands {
  std::vector<ReducedSegmentOf<Pack>> segments;
  std::vector<PointBlock> blocks;
  std::vector<RootMotion> roots;  // of each lane
  std::vector<Effects> effects;   // of each strand
};

/// These options with as many quadrature points as the strand has that needs most.
ReducedOptions with_same_points(std::span<const Strand> strands, Unknown unknown,
                                ReducedOptions options);

/// Throws InputError unless there are one to four strands, clamped, with the same
/// segments hanging on the same, under the stiff tangent and the recursive method.
PackedStrands packed(std::span<const Strand> strands, Unknown unknown,
                     const ReducedOptions& options, std::vector<Effects> effects);

}  // namespace tress::models
