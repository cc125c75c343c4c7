#pragma once

#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::constraint_drift {

/// The study `limit`: the largest Baumgarte gains before the feedback itself diverges,
/// beside the prediction from the method's step matrix (amplification.h). The prediction
/// covers the whole map of gains; it is measured where the feedback is useful, on a bead
/// that swings gently at the bottom of a circle.
std::vector<Case> feedback_limits(const CommandLine& line, const Settings& user);

}  // namespace tress::experiments::constraint_drift
