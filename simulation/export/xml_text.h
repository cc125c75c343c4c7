#pragma once

#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// Escapes a text for XML, as content or as the value of an attribute [XML 1.0,
/// sections 2.3 and 3.3.3]; other control characters are not allowed in XML.
std::string xml_text(std::string_view text);

}  // namespace tress::simulation
