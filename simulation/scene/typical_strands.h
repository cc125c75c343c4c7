#pragma once

#include <cstddef>
#include <vector>

#include "models/strand/strand.h"

namespace tress::simulation {

/// Indices of at most `most` strands that stand for all, ascending. What tells strands
/// apart: length and bending stiffness (logarithms), how far the natural shape turns
/// (rad), and how steeply the root points; each over its standard deviation. Along the
/// principal axis of these, the direction in which strands differ most, they are split
/// into groups of equal size, and each group gives the strand nearest to its mean: one is
/// the typical strand of the groom, several are typical of its quantiles. O(n log n).
std::vector<std::size_t> typical_strands(const std::vector<Strand>& strands,
                                         std::size_t most);

}  // namespace tress::simulation
