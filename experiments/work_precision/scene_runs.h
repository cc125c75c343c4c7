#pragma once

#include <string>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::work_precision {

/// Rows for scene files: the tips' error against wall time, root mean square over the run
/// and over the length, by every selected strand model and integrator. A fixed step
/// starts at one frame and is halved until several steps succeeded or the next one would
/// exceed the work limit of a run; of the coarser ones that failed only the finest is
/// kept.
///
/// time: against the same model at a much finer step; total: against the continuous rod,
/// where strands do not touch each other. References are computed here. Throws InputError
/// on scenes without strands and on two of one name.
std::vector<Case> scene_runs(const CommandLine& line, const Settings& settings,
                             const std::vector<std::string>& files);

}  // namespace tress::experiments::work_precision
