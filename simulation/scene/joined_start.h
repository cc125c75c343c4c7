#pragma once

#include <string>
#include <vector>

#include "contract/system.h"

namespace tress::simulation {

/// Lets joined strands begin on their joints at t = 0. Points that are apart by rounding
/// are moved together, and velocities are projected onto those that joints and supports
/// admit. `system` is a JoinedSystem, `places` the locations of its joints. Throws
/// InputError with the location of a joint whose points begin farther apart.
void begin_on_joints(System& system, const std::vector<std::string>& places);

}  // namespace tress::simulation
