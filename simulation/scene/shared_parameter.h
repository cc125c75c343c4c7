#pragma once

#include <string_view>

#include "contract/layers.h"
#include "contract/parameters.h"

namespace tress::simulation {

/// The one of strand_parameters() with this name, with its range and help.
Parameter shared_parameter(std::string_view name);

}  // namespace tress::simulation
