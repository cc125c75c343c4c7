#pragma once

#include <span>
#include <vector>

#include "experiments/run/experiment.h"

namespace tress::experiments::calibrate {

/// Keys of --set that choose records and how they are fitted.
std::span<const Parameter> calibrate_settings();

/// Fits of the user's records, of records that the user's scene would leave, or of those
/// of experiments/calibrate/data. Throws InputError on what cannot be read or made.
std::vector<Case> calibrate_cases(const CommandLine& line);

}  // namespace tress::experiments::calibrate
