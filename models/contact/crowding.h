#pragma once

#include "models/contact/strand_partners.h"

namespace tress::models {

// How strands crowd where the last update put them. They are sampled at most `apart` (m)
// apart, up to 64 samples a segment.

/// Pairs of strands of which a sample of one is closer than `apart` to the other.
long touching_pairs(const StrandPartners& strands, double apart, const Loop& loop);

/// Distance from a strand to the nearest other one, mean over the length of all strands,
/// m; by a tree of boxes, O(samples log segments). Infinite for a single strand, NaN
/// where places are not finite.
double mean_distance(const StrandPartners& strands, double apart, const Loop& loop);

}  // namespace tress::models
