#include "experiments/problems/scene_files.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "contract/input_error.h"
#include "experiments/problems/formulations.h"
#include "simulation/run/world.h"
#include "simulation/scene/changes.h"

namespace tress {

std::vector<SceneFile> read_strand_scenes(const std::vector<std::string>& files) {
  std::vector<SceneFile> all;
  std::set<std::string> names;
  for (const std::string& file : files) {
    const std::string name = std::filesystem::path(file).filename().string();
    if (!names.insert(name).second) {
      throw InputError("two scenes of one name", file, "rename one of them");
    }
    all.push_back({name, read_scene(file)});
    if (!all.back().scene.strands.empty()) continue;
    throw InputError(
        "the model brings its own geometry: no other model can do this scene", file,
        "give a scene with [strand] or [groom]");
  }
  return all;
}

Scene driven(Scene scene, const ModelEntry& model, const IntegratorEntry& entry) {
  if (scene.model != &model) scene = with_method(scene, {&model, {}, {}, {}});
  const auto system =
      model.on_strand(scene.strands.front(), scene.model_options, make_effects(scene));
  const auto usable = usable_formulations(entry, *system);
  if (usable.empty()) {
    throw InputError(refusal(entry, *system, entry.formulations.front()),
                     std::string(entry.id) + " on " + std::string(model.id),
                     "./tress list shows what can drive what");
  }
  scene.integrator = entry.id;
  scene.options.formulation = usable.front();
  return scene;
}

std::size_t most_elements(const Scene& scene) {
  std::size_t most = 0;
  for (const Strand& strand : scene.strands) {
    most = std::max(most, strand.segments.size());
  }
  return most;
}

}  // namespace tress
