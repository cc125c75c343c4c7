#pragma once

#include <span>

#include "contract/layers.h"
#include "contract/weights.h"

namespace tress {

/// Read-only argument of a call: a view of numbers.
using In = std::span<const double>;
/// Result of a call: a view of numbers, of which every one is written.
using Out = std::span<double>;
/// Argument that a call reads and changes.
using InOut = std::span<double>;

/// Outcome of a call inside a step: `ok`, `retry` requests a smaller step, `fatal` ends
/// the run. Values agree with SUNDIALS' 0 / +1 / -1 through `sundials_code`.
enum class [[nodiscard]] Status{ok, retry, fatal};

}  // namespace tress
