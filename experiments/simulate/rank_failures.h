#pragma once

#include <functional>

#include "experiments/run/interruption.h"
#include "simulation/head/ranks.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// The result of `run` on each of several ranks, of which the first alone speaks. Where
/// ranks fail, one of them prints the reason on standard error in one line, with its
/// rank and its machine unless it is the first. All end with the exit_code() of that
/// failure.
int exit_code_of_ranks(Ranks& ranks, Interruption& interruption,
                       const std::function<int()>& run);

}  // namespace tress::experiments::scene_runs
