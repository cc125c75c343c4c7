#pragma once

#include <string>
#include <vector>

#include "experiments/numerics/stability.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::stability_limit {

/// How the limits of scenes are looked for.
struct SceneLimits {
  StepSearch search;
  double most_work;  // of a row, total_work()
  double horizon;    // s that a run simulates, at most the scene's duration
  std::size_t strands;
  int repeat;
};

/// Rows about scene files: the largest step of each method such that the scene as a whole
/// keeps what the guard of simulations asks for (Guard), and no step has to be repeated
/// by shorter ones. Of many strands that do not touch each other, typical ones. Throws
/// InputError on --models and --elements, which a scene says itself.
std::vector<Case> scene_cases(const CommandLine& line,
                              const std::vector<std::string>& files,
                              const SceneLimits& how);

}  // namespace tress::experiments::stability_limit
