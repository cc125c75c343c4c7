#pragma once

#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::constraint_drift {

/// The study `limit`: how large may Baumgarte's gains be before the feedback itself
/// diverges, beside what the method's step matrix says (amplification.h). The prediction
/// is for the whole map of gains; it is measured where the feedback is of use, on a bead
/// that swings gently at the bottom of a circle.
std::vector<Case> feedback_limits(const CommandLine& line, const Settings& user);

}  // namespace tress::experiments::constraint_drift
