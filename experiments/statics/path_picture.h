#pragma once

#include <string>
#include <vector>

#include "experiments/statics/path_rows.h"

namespace tress::experiments::statics {

/// Draws a path as SVG: load against displacement, solid where it is stable, with its
/// limit points and bifurcations, and next to it shapes of the strand along the path.
/// `title` stands above.
std::string path_picture(const std::vector<PathPoint>& path, const Gauge& gauge,
                         const Varied& varied, const std::string& title);

}  // namespace tress::experiments::statics
