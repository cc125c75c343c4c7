#include "experiments/cost_of_accuracy/scene_measure.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "contract/input_error.h"
#include "experiments/numerics/tip_track.h"
#include "simulation/run/tip_paths.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Shorter runs are repeated: reading the clock at every frame contributes to them.
constexpr double short_run = 0.01;  // s
constexpr int short_repeats = 3;

/// Runs that are timed again take at least this long in total: caches and clock rates
/// settle.
constexpr double long_enough = 0.01;  // s

/// Mean iterations of a step beyond which no run is the cheapest: an undisturbed one
/// takes three or four, and halving the step reduces them.
constexpr double most_iterations = 10;

}  // namespace

WallTime wall_time(const std::vector<double>& seconds) {
  double least[] = {seconds.front(), seconds.back()};
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    least[i % 2] = std::min(least[i % 2], seconds[i]);
  }
  const auto [low, high] = std::minmax(least[0], least[1]);
  return {low, high / low - 1};
}

Scene SceneMeasure::scene(const Method& method, int elements, int substeps) const {
  return compared(trial_scene(given_, method, elements, substeps, comparison_.rate),
                  comparison_);
}

std::optional<Trial> SceneMeasure::quick(const Method& method, int elements, int substeps,
                                         double most_s) const {
  try {
    const Scene run = scene(method, elements, substeps);
    const TipPaths paths = tip_paths(run, 0, {most_iterations, most_s});
    const double wall_s = paths.once_s < short_run
                              ? wall_time(wall_times(run, short_repeats)).least_s
                              : paths.once_s;
    Trial made{0, elements, substeps, tip_error(paths.x, reference_, comparison_.length),
               wall_s};
    made.indicator = paths.indicator;
    return made;
  } catch (const InputError&) {  // refused at this number of elements
    return {};
  } catch (const std::runtime_error&) {
    return {};
  }
}

double SceneMeasure::changed_error(const Method& method, int elements, int substeps,
                                   Change change, double most_s) const {
  const std::vector<double>& reference =
      change == Change::up ? changed_.up : changed_.down;
  try {
    const Scene run = changed(scene(method, elements, substeps), change);
    return tip_error(tip_paths(run, 0, {most_iterations, most_s}).x, reference,
                     comparison_.length);
  } catch (const std::runtime_error&) {  // including refusals: InputError is one
    return std::numeric_limits<double>::infinity();
  }
}

std::optional<Trial> SceneMeasure::best_of(const Scene& given, int count) const {
  const Scene run = compared(given, comparison_);
  try {
    const TipPaths paths = tip_paths(run, 0);
    Trial made{0, 0, 0, tip_error(paths.x, reference_, comparison_.length),
               wall_time(wall_times(run, count, long_enough)).least_s};
    made.indicator = paths.indicator;
    return made;
  } catch (const std::runtime_error&) {
    return {};
  }
}

WallTime SceneMeasure::time(const Method& method, int elements, int substeps,
                            int count) const {
  return wall_time(wall_times(scene(method, elements, substeps), count, long_enough));
}

double SceneMeasure::error(const Method& method, int elements, int substeps,
                           const std::vector<double>& reference) const {
  return tip_error(tip_paths(scene(method, elements, substeps), 0).x, reference,
                   comparison_.length);
}

}  // namespace tress::experiments::cost_of_accuracy
