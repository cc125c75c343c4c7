#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Tips of all strands at every frame, and how long the run took.
struct TipPaths {
  std::vector<double> x;  // (3 strands) of frame 0, of frame 1 ...
  double once_s = 0;      // time of the run that was read (ThreadTimer)
  double wall_s = 0;      // once_s if that is long, else the median of repeats
  double indicator = 0;   // World::error_indicator at the end
  Stats stats;            // World::stats at the end
  double work = 0;        // World::work at the end
};

/// Limits at which a run is abandoned, checked after every frame.
struct RunLimit {
  double iterations_per_step = std::numeric_limits<double>::infinity();  // Newton's, mean
  /// Wall time of the run.
  double wall_s = std::numeric_limits<double>::infinity();
  double own_s = std::numeric_limits<double>::infinity();  // of ThreadTimer
  /// Whether the tips so far show that the run is of no use; empty: never.
  std::function<bool(const std::vector<double>& x)> useless = {};
};

/// Throws InputError if the scene cannot be built, and std::runtime_error, with cause and
/// time, if it does not run to its end or exceeds `limit`.
TipPaths tip_paths(const Scene& scene, int repeat, const RunLimit& limit = {});

/// Times of some runs to the end (s, ThreadTimer): of `runs`, or more until they total
/// `at_least_s`. Without the guard, which is not part of a method's cost.
std::vector<double> wall_times(const Scene& scene, int runs, double at_least_s = 0);

/// Root mean square distance over frames and strands, over the strands' mean length.
double distance_rel(const TipPaths& a, const TipPaths& b, const Scene& scene);

}  // namespace tress::simulation
