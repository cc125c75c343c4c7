#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Positions that a run is compared by, at every frame, and how long the run took.
struct TipPaths {
  /// (3 points) of frame 0, of frame 1 ...: the tips of all strands, or points along
  /// each.
  std::vector<double> x;
  std::size_t group = 1;    // points that have one error, the largest (grouped_distance)
  std::size_t systems = 0;  // World::systems
  double once_s = 0;        // time of the run that was read (ThreadTimer)
  double wall_s = 0;        // once_s if that is long, else the median of repeats
  double indicator = 0;     // World::error_indicator at the end
  Stats stats;              // World::stats at the end
  double work = 0;          // World::work at the end
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

/// Positions at a frame: the tips, or the ends of this number of equal parts of each
/// strand, the root first. Points between the ends of elements are interpolated.
struct ReadPoints {
  int parts = 0;  // 0: tips
};
/// The points for strands whose tips a support or a joint may hold.
inline constexpr ReadPoints along_strands{16};

/// Throws InputError if the scene cannot be built, and std::runtime_error, with cause and
/// time, if it does not run to its end or exceeds `limit`.
TipPaths tip_paths(const Scene& scene, int repeat, const RunLimit& limit = {},
                   const ReadPoints& read = {});

/// Returns these positions at t = 0. Throws InputError if the scene cannot be built.
std::vector<double> points_at_start(const Scene& scene, const ReadPoints& read);

/// Times of some runs to the end (s, ThreadTimer): of `runs`, or more until they total
/// `at_least_s`. Without the guard, which is not part of a method's cost.
std::vector<double> wall_times(const Scene& scene, int runs, double at_least_s = 0);

/// Returns the root mean square, over groups of this number of points, of the largest
/// distance in each (m). Infinite where a point is missing or not finite.
double grouped_distance(std::span<const double> a, std::span<const double> b,
                        std::size_t group);

/// grouped_distance() over the strands' mean length: of tips, the root mean square over
/// frames and strands.
double distance_rel(const TipPaths& a, const TipPaths& b, const Scene& scene);

}  // namespace tress::simulation
