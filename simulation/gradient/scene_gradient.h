#pragma once

#include <string>
#include <vector>

#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// The points of one strand at frames, and their derivatives.
struct StrandGradient {
  std::vector<std::vector<double>> points;  // at each frame: (3 points) m
  /// Derivatives by each parameter, at each frame: m over SceneParameter::unit.
  std::vector<std::vector<std::vector<double>>> by;
  std::string unfinished;  // why its run ended after these frames; empty: it did not
  std::string not_smooth;  // why its motion is not smooth; empty: not known to be
  /// Largest distance of the points of a run with a tolerance from those of the run with
  /// its accepted steps frozen, over the length.
  double moved = 0;
};

/// Derivatives of a scene's run. Those of strands that choose their steps are of the run
/// with its accepted steps frozen, which also end at frames.
struct SceneGradient {
  std::vector<SceneParameter> parameters;  // parameters in the order of [gradient]
  bool damped = false;                     // how it began
  std::vector<StrandGradient> strands;     // derivatives of each strand
};

/// Throws InputError if the scene has no [gradient], or its run no derivatives.
void check_gradient(const Scene& scene);

/// The gradient that [gradient] asks for, with every step divided into `parts`.
SceneGradient scene_gradient(const Scene& scene, int parts = 1);

}  // namespace tress::simulation
