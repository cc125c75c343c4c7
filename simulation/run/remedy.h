#pragma once

#include <string>
#include <string_view>

#include "integrators/catalogue.h"

namespace tress::simulation {

/// Returns true if the method ends a step after a given number of sweeps, whether its
/// equations are solved or not.
bool ends_after_sweeps(const integrators::IntegratorEntry& method);

/// Suggests what to try instead of this method at this step (s); `limit`: the bound that
/// ended the run, if any. `model`: id of the model, where it is known.
std::string remedy(std::string_view integrator, const Options& options,
                   Limit limit = Limit::none, std::string_view model = {});

}  // namespace tress::simulation
