#pragma once

#include <string_view>

#include "contract/layers.h"
#include "math/vec3.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// The vector of `key`, normalised. Throws InputError with its location when it is 0.
Vec direction(const Table& table, std::string_view key);

}  // namespace tress::simulation
