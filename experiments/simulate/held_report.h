#pragma once

#include <string>
#include <vector>

#include "simulation/rest/held_shape.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// Prints how the strands of a scene with rest = "inverse" are held, names those that
/// would fall, and writes `file` with one line per strand.
void report_held(const Scene& scene, const std::vector<HeldShape>& all,
                 const std::string& file);

/// The scene without the strands that would fall where it leaves them out (unstable =
/// "drop"), after a report of all; throws InputError if none remains. Other scenes as
/// they are.
Scene without_falling(Scene scene, const std::string& file, int threads);

}  // namespace tress::experiments::scene_runs
