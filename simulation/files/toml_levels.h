#pragma once

#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// Throws InputError with file:line:column where a value of `text` lies more than 100
/// levels deep: toml++ and what reads its tables go down one call per level, and the
/// levels of dotted keys, which it does not count itself, would use up the stack. Levels
/// are dots of keys and of headers, and brackets around values. Of malformed TOML this
/// holds up to the first error, where toml++ stops.
void refuse_deep(std::string_view text, const std::string& file);

}  // namespace tress::simulation
