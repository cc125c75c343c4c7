#pragma once

#include <span>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Returns whether a step that ends at one of the changes ends at t, or within a step
/// after it.
bool near_change(std::span<const double> changes, double t, double step);

/// Returns whether points of a strand overlap a body with exact contact at the start, by
/// more than rounding. Such contacts are closed at the depth that they have there, which
/// moves with the parameters.
bool begins_inside(const Scene& scene, std::size_t strand);

}  // namespace tress::simulation
