#pragma once

#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::work_precision {

/// The rows about problems whose end is known (problems()): every integrator from loose
/// to tight. The Beam by cvode_bdf has every maximum order, which that of its usual one
/// is among.
std::vector<Case> problem_runs(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::work_precision
