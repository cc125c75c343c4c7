#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulation/groom/polylines.h"

namespace tress::simulation {

/// Length of a polyline.
double polyline_length(std::span<const Vec> points);

/// The distribution of the strands' lengths (m), and outliers, one sentence each:
/// strands four times as long as the median or a tenth as long, and strands of which
/// one piece is longer than all others together, ten times as long as their median.
std::vector<std::string> notes_on_lengths(const Polylines& lines);

}  // namespace tress::simulation
