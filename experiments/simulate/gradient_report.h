#pragma once

#include <string>

#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// Throws InputError where the table of derivatives would be too large to be written.
void check_gradient_table(const Scene& scene);

/// Writes the derivatives that the scene's [gradient] asks for to a table, with the
/// change of each by half the steps, and prints those of the last tip in words. False: a
/// run did not come to its end.
bool report_gradient(const Scene& scene, const std::string& file);

}  // namespace tress::experiments::scene_runs
