#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Describes the deepest overlap of two strands that rub ([effects.strand_friction]) at
/// t = 0 and names its remedy. Empty where none is deeper than half their thickness:
/// roots may overlap, and contact resolves a shallow overlap. x: points of all strands,
/// strand after strand, `points` of each. O(strands^2) bounding boxes.
std::string overlap_at_start(const Scene& scene, const std::vector<int>& points, In x);

}  // namespace tress::simulation
