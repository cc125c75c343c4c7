#pragma once

#include <vector>

#include "integrators/entry.h"
#include "models/effects/catalogue.h"
#include "models/entry.h"
#include "simulation/plugin/build_stamp.h"

namespace tress::simulation {

/// Contents of a plug-in: entries of the catalogues. Texts and tables that they name must
/// live as long as the library.
struct Plugin {
  std::vector<models::ModelEntry> models;  // entries of the catalogue of models
  /// Entries of the list of integrators.
  std::vector<integrators::IntegratorEntry> integrators;
  std::vector<models::EffectEntry> effects;  // entries of the catalogue of effects
};

}  // namespace tress::simulation

/// Makes a shared library a plug-in, once in one of its sources; `bring` is a function
/// void(tress::simulation::Plugin&), called once, when the library is loaded.
#define TRESS_PLUGIN(bring)                                                             \
  __attribute__((                                                                       \
      used)) static constinit const tress::simulation::BuildStamp tress_plugin_stamp{}; \
  extern "C" __attribute__((visibility("default"))) void tress_plugin(                  \
      tress::simulation::Plugin& plugin) {                                              \
    bring(plugin);                                                                      \
  }                                                                                     \
  static_assert(true)
