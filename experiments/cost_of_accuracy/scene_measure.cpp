#include "experiments/cost_of_accuracy/scene_measure.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "experiments/harness/tip_track.h"
#include "experiments/scenes/variants.h"
#include "models/input_error.h"

namespace tress {
namespace {

/// Shorter runs are repeated: one interruption is a large part of them.
constexpr double short_run = 0.01;  // s
constexpr int short_repeats = 2;

}  // namespace

Scene SceneMeasure::scene(const Method& method, int elements, int substeps) const {
  return compared(text_.scene(method, elements, substeps, comparison_.rate), comparison_);
}

std::optional<Trial> SceneMeasure::quick(const Method& method, int elements, int substeps,
                                         double most_s) const {
  try {
    const Scene run = scene(method, elements, substeps);
    TipPaths paths = tip_paths(run, 0, most_s);
    if (paths.wall_s < short_run) {
      for (int i = 0; i < short_repeats; ++i) {
        paths.wall_s = std::min(paths.wall_s, tip_paths(run, 0).wall_s);
      }
    }
    return Trial{0, elements, substeps,
                 tip_error(paths.x, reference_, comparison_.length), paths.wall_s};
  } catch (const InputError&) {  // refused at this number of elements
    return {};
  } catch (const std::runtime_error&) {
    return {};
  }
}

std::optional<Trial> SceneMeasure::best_of(const Scene& given, int count) const {
  const Scene run = compared(given, comparison_);
  Trial best{0, 0, 0, 0, std::numeric_limits<double>::infinity()};
  try {
    for (int i = 0; i < count; ++i) {
      const TipPaths paths = tip_paths(run, 0);
      best.error = tip_error(paths.x, reference_, comparison_.length);
      best.wall_s = std::min(best.wall_s, paths.wall_s);
    }
  } catch (const std::runtime_error&) {
    return {};
  }
  return best;
}

double SceneMeasure::time(const Method& method, int elements, int substeps,
                          int count) const {
  const Scene run = scene(method, elements, substeps);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < std::max(1, count); ++i) {
    least = std::min(least, tip_paths(run, 0).wall_s);
  }
  return least;
}

double SceneMeasure::error(const Method& method, int elements, int substeps,
                           const std::vector<double>& reference) const {
  return tip_error(tip_paths(scene(method, elements, substeps), 0).x, reference,
                   comparison_.length);
}

}  // namespace tress
