#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::head_accuracy {

/// Returns the names of the family of grooms. Grooms are straight, wavy or curly; `alike`
/// or varied in length, curl and bending direction; released from straight, or shaken
/// with the head.
std::vector<std::string> groom_names();

/// Returns one of the grooms as a scene of `hairs` hairs. Throws InputError on other
/// names.
std::string groom_text(std::string_view name, std::size_t hairs);

}  // namespace tress::experiments::head_accuracy
