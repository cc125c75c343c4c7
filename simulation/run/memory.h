#pragma once

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Throws InputError, with both figures, where the strands of a scene need more memory
/// than the machine has left: what a few of them take, for each element, times all
/// elements. Small scenes are not measured.
void refuse_too_large(const Scene& scene);

}  // namespace tress::simulation
