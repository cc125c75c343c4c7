#include "experiments/cost_of_accuracy/scene_measure.h"

#include <stdexcept>

#include "experiments/harness/tip_track.h"
#include "experiments/scenes/variants.h"
#include "models/input_error.h"

namespace tress {
namespace {

/// Shorter runs are repeated: reading the clock at every frame is a part of them.
constexpr double short_run = 0.01;  // s
constexpr int short_repeats = 3;

/// What is timed once more runs for so long altogether: caches and clock rates settle.
constexpr double long_enough = 0.01;  // s

}  // namespace

Scene SceneMeasure::scene(const Method& method, int elements, int substeps) const {
  return compared(text_.scene(method, elements, substeps, comparison_.rate), comparison_);
}

std::optional<Trial> SceneMeasure::quick(const Method& method, int elements, int substeps,
                                         double most_s) const {
  try {
    const Scene run = scene(method, elements, substeps);
    const TipPaths paths = tip_paths(run, 0, most_s);
    const double wall_s =
        paths.once_s < short_run ? least_wall_s(run, short_repeats) : paths.once_s;
    return Trial{0, elements, substeps,
                 tip_error(paths.x, reference_, comparison_.length), wall_s};
  } catch (const InputError&) {  // refused at this number of elements
    return {};
  } catch (const std::runtime_error&) {
    return {};
  }
}

std::optional<Trial> SceneMeasure::best_of(const Scene& given, int count) const {
  const Scene run = compared(given, comparison_);
  try {
    const double error = tip_error(tip_paths(run, 0).x, reference_, comparison_.length);
    return Trial{0, 0, 0, error, least_wall_s(run, count, long_enough)};
  } catch (const std::runtime_error&) {
    return {};
  }
}

double SceneMeasure::time(const Method& method, int elements, int substeps,
                          int count) const {
  return least_wall_s(scene(method, elements, substeps), count, long_enough);
}

double SceneMeasure::error(const Method& method, int elements, int substeps,
                           const std::vector<double>& reference) const {
  return tip_error(tip_paths(scene(method, elements, substeps), 0).x, reference,
                   comparison_.length);
}

}  // namespace tress
