#pragma once

#include "simulation/scene/scene.h"

namespace tress::experiments {

/// Wall time (s) per step dt of the whole scene from its start, averaged over `steps`
/// steps, at most 200. Excludes the guard, which is not part of the method's cost. Throws
/// std::runtime_error where a step has no solution.
double step_cost(Scene scene, double dt, double steps, int repeat);

}  // namespace tress::experiments
