#pragma once

#include <string>
#include <vector>

#include "experiments/simulate/scene_run.h"

namespace tress::experiments::scene_runs {

/// What a run that came to its end found wrong with itself, one sentence each: a method
/// that changed the energy by a large part, a model without a smooth motion.
std::vector<std::string> warnings(const Scene& scene, const SceneRun& run);

}  // namespace tress::experiments::scene_runs
