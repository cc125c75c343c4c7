#pragma once

#include <string_view>

#include "contract/layers.h"

namespace tress::models {

/// Whether this word of an option is kept to show that it loses digits. Nothing that
/// recommends a configuration may take it.
bool loses_digits(std::string_view option, std::string_view word);

}  // namespace tress::models
