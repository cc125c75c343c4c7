#pragma once

#include "simulation/scene/scene.h"

namespace tress::experiments {

/// Wall time (s) of a step dt of the whole scene from its start, over so many steps but
/// not more than a row can wait for. Without the guard, which is no part of what a method
/// costs. Throws std::runtime_error where a step has no solution.
double step_cost(Scene scene, double dt, double steps, int repeat);

}  // namespace tress::experiments
