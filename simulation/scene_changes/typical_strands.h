#pragma once

#include <cstddef>
#include <vector>

#include "models/strand/strand.h"

namespace tress::simulation {

/// Returns the indices, ascending, of at most `most` strands that represent all. Features
/// are length and bending stiffness (logarithms), total turn of the natural shape (rad),
/// and steepness of the root direction, each over its standard deviation. Strands are
/// split into groups of equal size along their principal axis, the direction in which
/// they differ most. Each group contributes the strand nearest to its mean: one is the
/// typical strand of the groom, several represent its quantiles. O(n log n).
std::vector<std::size_t> typical_strands(const std::vector<Strand>& strands,
                                         std::size_t most);

}  // namespace tress::simulation
