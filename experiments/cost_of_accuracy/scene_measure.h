#pragma once

#include <optional>
#include <vector>

#include "experiments/cost_of_accuracy/changed_data.h"
#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/cost_of_accuracy/trial.h"

namespace tress::experiments::cost_of_accuracy {

/// Repeated times of one run: the least (s), since what else the machine does only adds
/// to it, and how well it repeats, the least of every second one against that of the
/// others, less 1.
struct WallTime {
  double least_s = 0, scatter = 0;
};
WallTime wall_time(const std::vector<double>& seconds);

/// Runs a scene by any method and compares its tips with the reference. Times are wall
/// times of stepping on one thread, the least of several runs.
///
/// A run is given up by the count of its Newton iterations, so that what comes of it does
/// not depend on the machine, and only in an emergency after `most_s`.
class SceneMeasure {
 public:
  SceneMeasure(const Scene& given, const Comparison& comparison,
               std::vector<double> reference, ChangedTips changed = {})
      : given_(given),
        comparison_(comparison),
        reference_(std::move(reference)),
        changed_(std::move(changed)) {}

  /// Once, and a few times more when it is short. No value where the method cannot do
  /// the scene, fails, or is given up.
  std::optional<Trial> quick(const Method& method, int elements, int substeps,
                             double most_s) const;
  /// The error with changed data, against their reference; infinite where `quick` has no
  /// value.
  double changed_error(const Method& method, int elements, int substeps, Change change,
                       double most_s) const;
  /// The same as `quick` of any scene, `count` times.
  std::optional<Trial> best_of(const Scene& scene, int count) const;
  /// The time alone.
  WallTime time(const Method& method, int elements, int substeps, int count) const;
  /// Against another reference.
  double error(const Method& method, int elements, int substeps,
               const std::vector<double>& reference) const;

 private:
  Scene scene(const Method& method, int elements, int substeps) const;

  const Scene& given_;
  Comparison comparison_;
  std::vector<double> reference_;
  ChangedTips changed_;
};

}  // namespace tress::experiments::cost_of_accuracy
