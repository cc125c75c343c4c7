#pragma once

#include <string_view>

#include "contract/parameters.h"

namespace tress {

/// The parameter that every strand model has under this name, with its range and help.
Parameter shared_parameter(std::string_view name);

}  // namespace tress
