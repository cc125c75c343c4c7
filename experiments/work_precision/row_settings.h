#pragma once

#include <span>
#include <string_view>

#include "experiments/run/settings.h"

namespace tress::experiments::work_precision {

/// Keys of --set that choose rows.
std::span<const Parameter> row_settings();

/// Whether the user's choice of rows leaves this word of a key in.
bool keeps(const Settings& settings, std::string_view key, std::string_view word);

}  // namespace tress::experiments::work_precision
