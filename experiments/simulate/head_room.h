#pragma once

#include "experiments/simulate/scene_run.h"

namespace tress::experiments::scene_runs {

/// Throws InputError, with both figures, if the batch of a scene needs more memory than
/// is available, or its frames more of the disk. Otherwise prints the needs on standard
/// error.
void check_room(const SceneOutline& outline, const SceneRunOptions& options);

}  // namespace tress::experiments::scene_runs
