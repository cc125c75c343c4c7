#pragma once

#include <string>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::work_precision {

/// Rows about scene files: the tips' error against wall time, root mean square over the
/// run and over the length, by every strand model and integrator that the user leaves in.
/// A fixed step is halved from a frame on until several steps got through or the next one
/// would take more work than a run may; above them stays the finest that did not.
///
/// time: against the same model at a much finer step; total: against the continuous rod,
/// where strands do not touch each other. References are computed here. Throws InputError
/// on scenes without strands and on two of one name.
std::vector<Case> scene_runs(const CommandLine& line, const Settings& settings,
                             const std::vector<std::string>& files);

}  // namespace tress::experiments::work_precision
