#pragma once

#include <optional>
#include <vector>

#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/cost_of_accuracy/search.h"

namespace tress {

/// Runs a scene by any method and compares its tips with the reference. Times are wall
/// times of stepping on one thread, the least of several runs: what else the machine does
/// only adds to them.
class SceneMeasure {
 public:
  SceneMeasure(const SceneText& text, const Comparison& comparison,
               std::vector<double> reference)
      : text_(text), comparison_(comparison), reference_(std::move(reference)) {}

  /// Once, and a few times more when it is short. No value where the method cannot do
  /// the scene, fails, or is not there after `most_s`.
  std::optional<Trial> quick(const Method& method, int elements, int substeps,
                             double most_s) const;
  /// The same of any scene, `count` times.
  std::optional<Trial> best_of(const Scene& scene, int count) const;
  /// The time alone, s.
  double time(const Method& method, int elements, int substeps, int count) const;
  /// Against another reference.
  double error(const Method& method, int elements, int substeps,
               const std::vector<double>& reference) const;

 private:
  Scene scene(const Method& method, int elements, int substeps) const;

  const SceneText& text_;
  Comparison comparison_;
  std::vector<double> reference_;
};

}  // namespace tress
