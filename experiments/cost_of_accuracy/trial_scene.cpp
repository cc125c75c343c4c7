#include "experiments/cost_of_accuracy/trial_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "simulation/files/run_key.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/element_unit.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::experiments::cost_of_accuracy {

Scene read_open_scene(const std::string& file) {
  Scene scene = read_scene(file);
  if (scene.strands.empty()) {
    throw InputError(
        "the model brings its own geometry: no other model can do this scene", file,
        "give a scene with [strand] or [groom]");
  }
  if (scene.strands_touch()) {
    throw InputError(
        "strands that touch each other: no two models agree on them for long", file,
        "leave out effects between strands");
  }
  static_cast<void>(simulation::element_unit(scene));
  return scene;
}

bool held(const Scene& scene) {
  return scene.tables != nullptr &&
         !(scene.tables->supports.empty() && scene.tables->joints.empty());
}

namespace {

constexpr double loosest_tolerance = 0.1;

int order_of(const Method& method) {
  return find_integrator(method.integrator).order(method.formulation).value();
}

}  // namespace

Accuracy accuracy(const Method& method, int substeps, double rate) {
  if (!method.by_tolerance) return {.step = 1 / (rate * substeps)};
  const double fineness = static_cast<double>(substeps) / fineness_unit;
  const double exact = loosest_tolerance * std::pow(fineness, -order_of(method));
  // As it is printed and written: what is run is what is said.
  const double shown = std::stod(fmt::format("{:.1e}", exact));
  return {.tolerance = std::min(shown, loosest_tolerance)};
}

int steps_unit(const Method& method) { return method.by_tolerance ? fineness_unit : 1; }

double frame_work(const Method& method, int elements, int substeps) {
  // A step with one linear solve is one; a stage needs several with the step's matrix.
  const int stages = find_integrator(method.integrator).stages;
  const double step = stages == 0 ? 1 : 0.5 + 0.3 * stages;
  const int all = elements + (method.extrapolated ? coarser(elements) : 0);
  return all * step * substeps / steps_unit(method);
}

double extrapolation(const Method& method, int elements) {
  return 1 / (std::pow(1. * elements / coarser(elements), method.model->order) - 1);
}

bool may_extrapolate(const Scene& scene) {
  return !held(scene) &&
         std::ranges::none_of(scene.effects, [](const EffectChoice& effect) {
           return effect.entry->contact;
         });
}

Scene trial_scene(Scene given, const Method& method, int elements, int substeps,
                  double rate) {
  return trial_scene(std::move(given), method, elements, accuracy(method, substeps, rate),
                     rate);
}

Scene trial_scene(Scene given, const Method& method, int elements, Accuracy accuracy,
                  double rate) {
  Scene scene = with_method(std::move(given), method);
  scene = method.cut_at_rest ? with_elements_at_rest(std::move(scene), elements)
                             : with_elements(std::move(scene), elements);
  if (method.by_tolerance) {
    scene.options.step = Options{}.step;  // does not count
    scene.options.tolerance = accuracy.tolerance;
  } else {
    scene.options.step = accuracy.step;
    scene.options.refresh = method.refresh;
    scene.options.newton_tolerance = newton_tolerance;
  }
  scene.frame_rate = rate;
  return scene;
}

std::string physics(Scene scene) {
  scene.title = scene.source = {};
  scene.frame_rate = scene.checkpoint = 0;
  scene = with_method(std::move(scene), {&model_catalogue().front(), {}, {}});
  scene.options = {};
  // The strands are not rediscretised: one element may be too few.
  scene.tables = std::make_shared<const StrandTables>(
      with_cuts(with_elements(*scene.tables, 1), "grading"));
  std::vector<std::string> files;
  for (EffectChoice& effect : scene.effects) {
    for (const Parameter& p : effect.entry->parameters) {
      if (!p.text || !p.name.ends_with("file")) continue;
      files.emplace_back(effect.parameters.word(p.name));
      effect.parameters.set(p.name, "");
    }
  }
  const std::string text = scene_text(scene);
  return files.empty() ? text : text + contents_checksum(files);
}

}  // namespace tress::experiments::cost_of_accuracy
