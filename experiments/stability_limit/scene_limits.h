#pragma once

#include <string>
#include <vector>

#include "experiments/numerics/stability.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::stability_limit {

/// Search parameters for the limits of scenes.
struct SceneLimits {
  StepSearch search;
  double most_work;  // per row, total_work()
  double horizon;    // s simulated per run, at most the scene's duration
  std::size_t strands;
  int repeat;
};

/// Rows for scene files: the largest step of each method such that the scene as a whole
/// satisfies the simulation guard (Guard), and no step has to be repeated with shorter
/// ones. Of many strands that do not touch each other, typical ones are run. Throws
/// InputError on --models and --elements, which a scene defines itself.
std::vector<Case> scene_cases(const CommandLine& line,
                              const std::vector<std::string>& files,
                              const SceneLimits& how);

}  // namespace tress::experiments::stability_limit
