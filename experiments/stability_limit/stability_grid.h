#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "experiments/problems/strand_scenes.h"
#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"
#include "simulation/files/row.h"

namespace tress {

/// Internal friction gamma (kg m^3/s) by name.
struct Damping {
  std::string_view name;
  std::string_view internal_friction;
};

/// One row of stability_limit: which strand, how it moves and who steps it.
struct StabilityCase {
  const StrandScene* scene;
  const ModelEntry* model;
  std::string_view integrator, solver, tangent, modes;
  int elements;
  Damping damping;

  Row identity() const;
  /// The model's: defaults, the user's, the scene's, this row's.
  Parameters parameters(const Settings& settings) const;
};

/// Keys of --set that choose rows and say how steps are searched.
std::span<const Parameter> stability_settings();

/// The rows that the command line and its settings leave, without those whose model the
/// integrator refuses.
std::vector<StabilityCase> stability_cases(const CommandLine& line,
                                           const Settings& settings);

}  // namespace tress
