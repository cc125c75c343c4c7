#pragma once

#include <string>
#include <vector>

#include "simulation/files/row.h"

namespace tress::experiments::statics {

/// Describes the paths of a table in sentences: limit points, bifurcations, where each
/// path is stable, how its points were verified, and how far the numbers of elements
/// agree.
std::vector<std::string> in_words(const std::vector<simulation::Row>& rows);

}  // namespace tress::experiments::statics
