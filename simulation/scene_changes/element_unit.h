#pragma once

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Returns the least number of equal elements of a strand, from 1 to 1000, with an end at
/// every point that [[supports]], [[joints]] and moments name. Multiples of it have ends
/// there as well. Throws InputError with the location of a point at which no such number
/// has an end, and of a strand whose elements are not equal.
int element_unit(const Scene& scene);

}  // namespace tress::simulation
