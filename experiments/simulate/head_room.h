#pragma once

#include "experiments/simulate/scene_run.h"

namespace tress::experiments::scene_runs {

/// Throws InputError, with both figures, if the head of a scene needs more memory than
/// there is, or its frames more of the disk; else says on standard error what they need.
void check_room(const SceneOutline& outline, const SceneRunOptions& options);

}  // namespace tress::experiments::scene_runs
