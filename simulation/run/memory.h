#pragma once

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Throws InputError, with both figures, if the strands of a scene need more memory than
/// the machine has left, extrapolated from a few of them by number of elements. Small
/// scenes are not measured.
void refuse_too_large(const Scene& scene);

/// Bytes on the heap of this program.
std::size_t heap_in_use();

/// Bytes that are available: of the machine, and of the address space if it is limited.
double free_memory();

}  // namespace tress::simulation
