#pragma once

#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::work_precision {

/// The rows for problems with a known end state (problems()): every integrator from loose
/// to tight tolerances. The Beam by cvode_bdf has every maximum order, including the
/// default.
std::vector<Case> problem_runs(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::work_precision
