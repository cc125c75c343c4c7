#pragma once

#include <span>
#include <string_view>

#include "experiments/run/settings.h"

namespace tress::experiments::work_precision {

/// --set keys that select rows.
std::span<const Parameter> row_settings();

/// Whether the user's choice for this key includes this value.
bool keeps(const Settings& settings, std::string_view key, std::string_view word);

}  // namespace tress::experiments::work_precision
