#pragma once

#include <string>
#include <vector>

#include "experiments/simulate/scene_run.h"
#include "simulation/export/full_hair.h"

namespace tress::experiments::scene_runs {

/// Writes <stem>.json and the requested files for other programs.
void write_pictures(const Animation& animation, const SceneRunOptions& options);

/// Drawn output of a run for the report page and other programs, all with the same lines.
class Pictures {
 public:
  /// Throws InputError where hairs cannot be interpolated between the scene's strands.
  Pictures(const Scene& scene, const World& world, const Readout& readout,
           const SceneRunOptions& options);
  void write(const std::vector<Frame3d>& frames,
             const std::vector<FurtherChannel>& further) const;

 private:
  std::vector<Frame3d> with(const std::vector<FurtherChannel>& further,
                            std::vector<Frame3d> frames) const;
  void write(const std::vector<Frame3d>& frames,
             const std::vector<Reading>& channels) const;

  const Scene& scene_;
  const Readout& readout_;
  const SceneRunOptions& options_;
  FullHair hair_;
  std::vector<DrawnLine> lines_;
};

}  // namespace tress::experiments::scene_runs
