#pragma once

#include "experiments/simulate/scene_run.h"

namespace tress::experiments::scene_runs {

/// run_scene() for a scene that runs as one head of hair: its frames go to <stem>.h5 and
/// .xdmf, strands that are lost to <stem>.lost.csv while the others go on, pictures are
/// of some strands. An interrupted run is continued with the same bits as one that never
/// was, from the last saved state or, after SIGINT or SIGTERM, from where it was.
SceneRun run_head(const SceneOutline& outline, const RunKey& key,
                  const SceneRunOptions& options, Interruption& interruption);

}  // namespace tress::experiments::scene_runs
