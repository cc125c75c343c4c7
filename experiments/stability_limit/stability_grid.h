#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "experiments/numerics/stability.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"
#include "integrators/catalogue.h"
#include "simulation/files/row.h"

namespace tress::experiments::stability_limit {

/// Internal friction gamma (kg m^3/s) by name.
struct Damping {
  std::string_view name;
  std::string_view internal_friction;
};

inline constexpr Damping undamped{"none", "0"};

/// One row of stability_limit: the strand, its motion and the method.
struct StabilityCase {
  const StrandScene* scene;
  const ModelEntry* model;
  std::string_view integrator, solver, tangent, modes;
  int elements;
  Damping damping;

  Row identity() const;
  /// Whether the command line and the settings select this row.
  bool selected(const CommandLine& line, const Parameters& rows) const;
  /// The model's: defaults, then the user's, the scene's, and this row's.
  Parameters parameters(const Settings& settings) const;
};

/// --set keys that select rows and control the search for steps.
std::span<const Parameter> stability_settings();

/// The user's value of this key; `usual` if it is 0.
double set_or(const Parameters& rows, std::string_view key, double usual);

/// Search parameters for steps; `finest` (s) and `depth` are defaults that the user may
/// override.
StepSearch step_search(const Parameters& rows, double finest, double depth);

/// Whether a study of all integrators includes this one: it has a step, and is named, or
/// is one that --quick keeps.
bool considered(const CommandLine& line, const IntegratorEntry& entry);

/// The rows that the command line and its settings select, without those whose model the
/// integrator refuses.
std::vector<StabilityCase> stability_cases(const CommandLine& line,
                                           const Settings& settings);

}  // namespace tress::experiments::stability_limit
