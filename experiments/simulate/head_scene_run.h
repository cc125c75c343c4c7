#pragma once

#include "experiments/simulate/scene_run.h"

namespace tress::experiments::scene_runs {

/// Runs a scene as one batch, as run_scene(). Frames go to <stem>.h5 and .xdmf, failed
/// strands to <stem>.failed.csv while the others continue. Pictures are of some strands.
/// An interrupted run continues bit-identically: from the last saved state or, after
/// SIGINT or SIGTERM, from the interruption.
SceneRun run_head(const SceneOutline& outline, const RunKey& key,
                  const SceneRunOptions& options, Interruption& interruption);

}  // namespace tress::experiments::scene_runs
