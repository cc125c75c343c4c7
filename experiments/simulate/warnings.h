#pragma once

#include <string>
#include <vector>

#include "experiments/simulate/scene_run.h"

namespace tress::experiments::scene_runs {

/// Returns the warnings of a run, one sentence each. They concern strands that nothing
/// holds, a method that changed the energy by a large part, and a model without a smooth
/// motion. Others concern strands that passed through a body within a step.
std::vector<std::string> warnings(const Scene& scene, const SceneRun& run);

}  // namespace tress::experiments::scene_runs
