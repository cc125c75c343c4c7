#pragma once

#include <string>

#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// Says how the strands of a scene with rest = "inverse" are held, every one that would
/// fall before it does, and writes `file`, a line each. The scene without those that fall
/// where it leaves them out (unstable = "drop"); throws InputError if none remains.
Scene settled(Scene scene, const std::string& file, int threads);

}  // namespace tress::experiments::scene_runs
