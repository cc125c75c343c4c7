#pragma once

#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/catalogue.h"
#include "simulation/plugin/load_plugin.h"

/// What suites over the catalogues test: all entries, or in a program that has loaded
/// plug-ins (check_main.cpp) those which these brought.
namespace tress::testing_support {

inline bool plugins_alone() { return !simulation::loaded_plugins().empty(); }

inline std::span<const models::ModelEntry> tested_models() {
  return plugins_alone() ? models::added_models() : models::model_catalogue();
}

inline std::span<const integrators::IntegratorEntry> tested_integrators() {
  return plugins_alone() ? integrators::added_integrators()
                         : integrators::integrator_catalogue();
}

inline std::span<const models::EffectEntry> tested_effects() {
  return plugins_alone() ? models::added_effects() : models::effects();
}

}  // namespace tress::testing_support
