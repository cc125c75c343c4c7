#pragma once

#include <functional>
#include <vector>

#include "experiments/run/experiment.h"

namespace tress::experiments {

enum class SweepEnd { complete, interrupted };

/// Runs every case in its own process, `jobs` at a time, in order. `finished` gets each
/// case's rows and run time as soon as the case ends. `running` gets, a few times a
/// second, the case that has run longest. stop_signals() stop the sweep: running cases
/// are killed and repeated by the next run.
SweepEnd sweep(const std::vector<Case>& cases, int jobs, double timeout_s,
               const std::function<void(std::vector<Row>, double seconds)>& finished,
               const std::function<void(const Case&, double seconds)>& running);

}  // namespace tress::experiments
