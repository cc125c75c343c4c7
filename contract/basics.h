#pragma once

#include <span>

#include "contract/layers.h"
#include "contract/weights.h"

namespace tress {

using In = std::span<const double>;
using Out = std::span<double>;
using InOut = std::span<double>;

/// Outcome of a call inside a step: `retry` requests a smaller step, `fatal` ends the
/// run. Values agree with SUNDIALS' 0 / +1 / -1 through `sundials_code`.
enum class [[nodiscard]] Status{ok, retry, fatal};

}  // namespace tress
