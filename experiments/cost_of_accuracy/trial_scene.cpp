#include "experiments/cost_of_accuracy/trial_scene.h"

#include <utility>

#include "contract/input_error.h"
#include "simulation/files/run_key.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/write_scene.h"

namespace tress::experiments::cost_of_accuracy {

Scene read_open_scene(const std::string& file) {
  Scene scene = read_scene(file);
  if (scene.strands.empty()) {
    throw InputError(
        "the model brings its own geometry: no other model can do this scene", file,
        "give a scene with [strand] or [groom]");
  }
  if (scene.interaction() != nullptr) {
    throw InputError(
        "strands that touch each other: no two models agree on them for long", file,
        "leave out [effects.strand_interaction]");
  }
  return scene;
}

Scene trial_scene(Scene given, const Method& method, int elements, int substeps,
                  double rate) {
  Scene scene = with_elements(with_method(std::move(given), method), elements);
  scene.options.step = 1 / (rate * substeps);
  scene.options.newton_tolerance = newton_tolerance;
  scene.frame_rate = rate;
  return scene;
}

std::string physics(Scene scene) {
  scene.title = scene.source = {};
  scene.frame_rate = scene.checkpoint = 0;
  scene = with_method(std::move(scene), {&model_catalogue().front(), {}, {}});
  scene.options = {};
  // The strands are not rediscretised: one element may be too few.
  scene.tables = std::make_shared<const StrandTables>(with_elements(*scene.tables, 1));
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
