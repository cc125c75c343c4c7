#pragma once

#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/work_precision/strand_grid.h"

namespace tress::experiments::work_precision {

/// The rows of strand_cases(): error of the tip, root mean square over the run, against
/// wall time. References are computed here, once for all rows that share one.
std::vector<Case> strand_runs(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::work_precision
