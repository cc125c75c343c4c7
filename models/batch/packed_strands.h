#pragma once

#include <span>
#include <vector>

#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Up to four strands, one per lane; unused lanes repeat the first strand.
struct PackedStrands {
  std::vector<ReducedSegmentOf<Pack>> segments;
  std::vector<PointBlock> blocks;
  std::vector<RootMotion> roots;  // one per lane
  Pack root_rotor;                // as ReducedStrand's
  std::vector<Effects> effects;   // one per strand
};

/// Returns these options with the largest number of quadrature points that any strand
/// needs.
ReducedOptions with_same_points(std::span<const Strand> strands, Unknown unknown,
                                ReducedOptions options);

/// Throws InputError unless there are one to four clamped strands with the same
/// segments and parents, and options select the elastic Jacobian and the recursive
/// method.
PackedStrands packed(std::span<const Strand> strands, Unknown unknown,
                     const ReducedOptions& options, std::vector<Effects> effects);

}  // namespace tress::models
