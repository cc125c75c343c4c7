#pragma once

#include <span>
#include <vector>

#include "experiments/run/experiment.h"

namespace tress::experiments::calibrate {

/// --set keys that select records and how they are fitted.
std::span<const Parameter> calibrate_settings();

/// Fits of the user's records, of records simulated from the user's scene, or of those in
/// experiments/calibrate/data. Throws InputError on what cannot be read or built.
std::vector<Case> calibrate_cases(const CommandLine& line);

}  // namespace tress::experiments::calibrate
