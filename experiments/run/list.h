#pragma once

#include <span>
#include <string>

#include "contract/parameters.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress::experiments {

/// What --list prints: models with their parameters, integrators, the experiment's and
/// the integrators' keys, and which integrator drives which model under which formulation
/// of the constraints, every gap with its reason.
std::string catalogue_text(std::span<const ModelEntry> models,
                           std::span<const IntegratorEntry> integrators,
                           std::span<const Parameter> experiment_settings);

}  // namespace tress::experiments
