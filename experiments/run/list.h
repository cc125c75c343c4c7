#pragma once

#include <span>
#include <string>

#include "contract/parameters.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress::experiments {

/// Returns the output of --list: models with their parameters, integrators, and the keys
/// of the experiment and of the integrators. It also lists which integrator drives which
/// model under which constraint formulation, with the reason for every gap.
std::string catalogue_text(std::span<const ModelEntry> models,
                           std::span<const IntegratorEntry> integrators,
                           std::span<const Parameter> experiment_settings);

}  // namespace tress::experiments
