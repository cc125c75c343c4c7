#pragma once

#include "simulation/table/table.h"

namespace tress::simulation {

/// Returns true if a support exerts the forces of springs alone, no constraints.
bool compliant(const Table& support);

}  // namespace tress::simulation
