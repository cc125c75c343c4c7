#pragma once

#include <string>
#include <vector>

#include "experiments/simulate/scene_run.h"
#include "simulation/export/full_hair.h"

namespace tress::experiments::scene_runs {

/// <stem>.json, and on request <stem>_vtk/ and <stem>.usda.
void write_pictures(const Animation& animation, const SceneRunOptions& options);

/// Drawn output of a run for the report page and other programs: <stem>.json, and on
/// request <stem>_vtk/ and <stem>.usda, all with the same lines.
class Pictures {
 public:
  /// Throws InputError where hairs cannot be interpolated between the scene's strands.
  Pictures(const Scene& scene, const World& world, const Readout& readout,
           const SceneRunOptions& options);
  void write(const std::vector<Frame3d>& frames) const;

 private:
  const Scene& scene_;
  const Readout& readout_;
  const SceneRunOptions& options_;
  FullHair hair_;
  std::vector<DrawnLine> lines_;
};

}  // namespace tress::experiments::scene_runs
