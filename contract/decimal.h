#pragma once

#include <optional>
#include <string_view>

namespace tress {

/// The double nearest to a number in decimal digits of any length: 0 below the least one,
/// infinite beyond the largest. Also reads inf and nan. None: the text is no number.
std::optional<double> decimal(std::string_view text);

}  // namespace tress
