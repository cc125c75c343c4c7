#include <algorithm>
#include <functional>

#include "experiments/cost_of_accuracy/scene_measure.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::cost_of_accuracy {

Scene changed(Scene scene, Change change) {
  const double factor = change == Change::up ? 1 + data_change : 1 - data_change;
  // Supports and joints hold places that another length would not reach.
  const double lengths = held(scene) ? 1 : factor;
  std::vector<Strand> strands = scene.strands;
  for (Strand& strand : strands) {
    strand.material.youngs_modulus *= factor;
    strand.material.shear_modulus *= factor;
    for (Segment& segment : strand.segments) segment.length *= lengths;
  }
  return with_strands(std::move(scene), std::move(strands));
}

namespace {

/// Tips with data up and down minus those with the given data, as the two sides of a
/// reference.
SceneReference differences(const Scene& given, const Comparison& comparison,
                           const ReferenceCut& cut) {
  const Method method{{&find_model("super_helix"), {}, "implicit_midpoint"}};
  const Scene scene =
      compared(trial_scene(given, method, cut.elements, cut.substeps, comparison.rate),
               comparison);
  const std::vector<double> as_it_is = compared_paths(scene, comparison).x;
  const auto difference = [&](Change change) {
    std::vector<double> x = compared_paths(changed(scene, change), comparison).x;
    std::ranges::transform(x, as_it_is, x.begin(), std::minus<>());
    return x;
  };
  SceneReference made{{difference(Change::up), difference(Change::down)},
                      comparison.frames};
  made.tips.gap = compared_error(made.tips.other, made.tips.tip, comparison);
  return made;
}

}  // namespace

ChangedTips kept_changed_tips(const Scene& given, const Comparison& comparison,
                              const SceneReference& reference, const ReferenceCut& cut,
                              const std::string& folder, const std::string& name) {
  static const ReferenceSides sides{
      "what a change of moduli and lengths by 2 % does to the tips: super_helix by "
      "implicit_midpoint",
      "up, less the tip as it is", "down, less the tip as it is"};
  Comparison known = comparison;
  known.frames = reference.frames;
  const SceneReference moved = first_frames(
      kept_sides(given, comparison, cut, folder, name + ".changed", sides, differences),
      known);
  const auto sum = [&reference](std::vector<double> x) {
    std::ranges::transform(x, reference.tips.tip, x.begin(), std::plus<>());
    return x;
  };
  return {sum(moved.tips.tip), sum(moved.tips.other)};
}

}  // namespace tress::experiments::cost_of_accuracy
