#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulation/groom/polylines.h"

namespace tress::simulation {

/// Length of a polyline.
double polyline_length(std::span<const Vec> points);

/// Returns the distribution of the strands' lengths (m), and outliers, one sentence each.
/// Outliers are strands four times as long as the median or a tenth as long. Strands with
/// one piece longer than all others together, and ten times as long as their median, are
/// also outliers.
std::vector<std::string> notes_on_lengths(const Polylines& lines);

}  // namespace tress::simulation
