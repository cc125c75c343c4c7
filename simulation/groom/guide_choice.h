#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contract/layers.h"
#include "models/strand/strand.h"

namespace tress::simulation {

/// Returns the points of a strand at t = 0: its root and the tips of its segments.
std::vector<Vec> initial_points(const Strand& strand);

/// Returns the strands of a groom that represent the others. The distance of two strands
/// is the root mean square distance of their roots and quarter points at t = 0. Place,
/// length and shape therefore count, in metres. The first guide is drawn by the seed, and
/// the farthest strand from all guides so far is the next one [Gonzalez 1985]. The middle
/// of each cluster then replaces its guide a few times [Lloyd 1982]. Ascending; all
/// strands if guides >= strands. O(strands guides).
std::vector<std::size_t> choose_guides(std::span<const Strand> strands,
                                       std::size_t guides, std::uint64_t seed);

/// Mean over strands of the squared distance from the nearest guide, m^2: what the choice
/// makes small.
double spread_about(std::span<const Strand> strands, std::span<const std::size_t> guides);

}  // namespace tress::simulation
