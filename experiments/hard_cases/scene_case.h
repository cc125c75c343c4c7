#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/hard_cases/scene_gauge.h"
#include "experiments/hard_cases/survival.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::hard_cases {

/// With the violated criterion, or the one nearest to its limit; it has a name and a
/// limit if it is one of SceneCriteria.
struct SceneSurvival : Survival {
  std::string_view measured;
  double limit = std::numeric_limits<double>::quiet_NaN();
  std::string_view criterion;
};

/// A scene as a hard case: runs it at its own step until t_end (s), or until a criterion
/// is violated. Stable if every step has a solution, the guard finds nothing and the
/// criteria are met; there is no reference for accuracy. `limit`: World::work().
SceneSurvival survive(const Scene& scene, const SceneCriteria& criteria, double t_end,
                      const WorkLimit& limit);

/// Rows for scene files: every strand model and integrator that the command line selects,
/// at the scene's step and at the standard ones; for a scene without strands its own
/// model. The scene's model keeps the scene's options, others have their defaults, with
/// the tangents of hard_grid(). Of many strands that do not touch each other, typical
/// ones are run. Throws InputError on settings that a scene defines itself.
std::vector<Case> scene_cells(const CommandLine& line, const Settings& settings);

}  // namespace tress::experiments::hard_cases
