#pragma once

#include <string>

#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// How far a scene with a tolerance is from one with a tenth of it.
struct Achieved {
  double error = 0;     // largest at a frame of a point, over the longest strand
  double at = 0;        // s
  std::string failure;  // why one of the two did not come to the end; empty: they did
};

/// Throws InputError if the scene has no strands or no tolerance.
void check_verifiable(const Scene& scene);

/// Runs both.
Achieved achieved_error(const Scene& scene, int threads);

}  // namespace tress::experiments::scene_runs
