#include "experiments/problems/scene_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "contract/input_error.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "simulation/run/world.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments {

std::vector<SceneFile> read_strand_scenes(const std::vector<std::string>& files) {
  std::vector<SceneFile> all;
  for (Scene& scene : read_scenes(files)) {
    const std::string& file = files[all.size()];
    if (scene.strands.empty()) {
      throw InputError(
          "the model brings its own geometry: no other model can do this scene", file,
          "give a scene with [strand] or [groom]");
    }
    refuse_if(
        simulation::has_driven_bodies(scene),
        "[effects.body] with moves = \"turns\" or \"free\", which is not part of the "
        "strand that this study makes",
        file, "use another motion of the body");
    all.push_back({std::filesystem::path(file).filename().string(), std::move(scene)});
  }
  return all;
}

Scene driven(Scene scene, const ModelEntry& model, const IntegratorEntry& entry) {
  const double tolerance = entry.error_controlled ? scene.options.tolerance : 0;
  if (scene.model != &model) scene = with_method(std::move(scene), {&model, {}, {}, {}});
  scene.options.tolerance = tolerance;
  scene.integrator = entry.id;
  if (simulation::has_constraints(scene)) {
    const Formulation given = scene.options.formulation;
    const bool keeps = given != Formulation::parametric && entry.order(given) &&
                       (tolerance == 0 || given != Formulation::index3);
    if (!keeps) {
      scene.options.formulation =
          simulation::formulation_of_supports(entry, tolerance > 0);
    }
    return scene;  // its run refuses a method that cannot drive it
  }
  const auto system = scene.strands.empty()
                          ? model.make(scene.model_options)
                          : model.on_strand(scene.strands.front(), scene.model_options,
                                            make_effects(scene));
  if (refusal(entry, *system, scene.options.formulation).empty()) return scene;
  const auto usable = preferred_formulation(entry, *system, scene.options.tolerance);
  if (!usable) {
    throw InputError(refusal(entry, *system, entry.formulations.front().formulation),
                     std::string(entry.id) + " on " + std::string(model.id),
                     "./tress list shows what can drive what");
  }
  scene.options.formulation = *usable;
  return scene;
}

std::set<std::string_view> scene_jacobians(const Scene& scene,
                                           std::string_view integrator) {
  if (first_word(*scene.model, "jacobian").empty()) return {""};
  std::set<std::string_view> all{scene.model_options.word("jacobian")};
  if (integrator == "linearly_implicit_euler") all.insert(usual_tangent(*scene.model));
  return all;
}

std::size_t most_elements(const Scene& scene) {
  std::size_t most = 0;
  for (const Strand& strand : scene.strands) {
    most = std::max(most, strand.segments.size());
  }
  return most;
}

}  // namespace tress::experiments
