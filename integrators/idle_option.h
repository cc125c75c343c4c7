#pragma once

#include <string_view>

#include "integrators/entry.h"

namespace tress::integrators {

/// Returns what a run lacks for a common option to have an effect; empty: it has one.
/// `option`: a name in common_options().
std::string_view idle_option(const IntegratorEntry& method, const Options& options,
                             std::string_view option);

}  // namespace tress::integrators
