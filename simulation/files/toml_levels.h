#pragma once

#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// Throws InputError with file:line:column where a value of `text` lies more than 100
/// levels deep: toml++ and the readers of its tables recurse once per level, and dotted
/// keys, which toml++ does not limit, would overflow the stack. Levels are dots of keys
/// and of headers, and brackets around values. In malformed TOML this holds up to the
/// first error, where toml++ stops.
void refuse_deep(std::string_view text, const std::string& file);

}  // namespace tress::simulation
