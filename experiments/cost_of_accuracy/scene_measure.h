#pragma once

#include <optional>
#include <vector>

#include "experiments/cost_of_accuracy/changed_data.h"
#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/cost_of_accuracy/trial.h"

namespace tress::experiments::cost_of_accuracy {

/// Repeated times of one run: the least (s), since other load on the machine only adds to
/// it, and its repeatability: the least of the even-numbered times against that of the
/// odd ones, less 1.
struct WallTime {
  double least_s = 0, scatter = 0;
};
WallTime wall_time(const std::vector<double>& seconds);

/// Runs a scene by any method and compares its tips with the reference. Times are wall
/// times of stepping on one thread, the least of several runs.
///
/// A run is abandoned by its count of Newton iterations, so that the result does not
/// depend on the machine, and only in an emergency after `most_s`.
class SceneMeasure {
 public:
  SceneMeasure(const Scene& given, const Comparison& comparison,
               std::vector<double> reference, ChangedTips changed = {})
      : given_(given),
        comparison_(comparison),
        reference_(std::move(reference)),
        changed_(std::move(changed)) {}

  /// One run, repeated a few times if it is short. Empty where the method cannot
  /// represent the scene, fails, or is abandoned.
  std::optional<Trial> quick(const Method& method, int elements, int substeps,
                             double most_s) const;
  /// The error with changed data, against their reference; infinite where `quick` is
  /// empty.
  double changed_error(const Method& method, int elements, int substeps, Change change,
                       double most_s) const;
  /// As `quick` for any scene, `count` times.
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
