#include "experiments/cost_of_accuracy/scene_text.h"

#include <filesystem>
#include <sstream>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "simulation/files/toml_text.h"

namespace tress {
namespace {

std::string written(const toml::table& table) {
  std::ostringstream stream;
  stream << toml::toml_formatter(table) << '\n';
  return std::move(stream).str();
}

/// Every [name] or [[name]].
template <class F>
void each(toml::table& scene, std::string_view name, const F& use) {
  if (toml::table* one = scene[name].as_table()) use(*one);
  if (toml::array* many = scene[name].as_array()) {
    for (toml::node& node : *many) use(*node.as_table());
  }
}

void cut(toml::table& scene, int elements) {
  for (const std::string_view name : {"strand", "groom"}) {
    each(scene, name,
         [elements](toml::table& one) { one.insert_or_assign("elements", elements); });
  }
}

void name_files_in_full(toml::table& scene, const std::string& file) {
  toml::table* effects = scene["effects"].as_table();
  if (effects == nullptr) return;
  const auto folder = std::filesystem::absolute(file).parent_path();
  each(*effects, "body", [&folder](toml::table& body) {
    const auto* name = body["sdf_file"].as_string();
    if (name == nullptr) return;
    body.insert_or_assign("sdf_file", (folder / name->get()).lexically_normal().string());
  });
}

}  // namespace

SceneText::SceneText(const std::string& file)
    : file_(file),
      text_(read_file(file, most_toml_bytes)),
      given_(parse_scene(text_, file)) {
  if (given_.strands.empty()) {
    throw InputError(
        "the model brings its own geometry: no other model can do this scene", file,
        "give a scene with [strand] or [groom]");
  }
  if (given_.interaction) {
    throw InputError(
        "strands that touch each other: no two models agree on them for long", file,
        "leave out [effects.strand_interaction]");
  }
}

std::string SceneText::with(const Method& method, int elements, int substeps,
                            double rate) const {
  toml::table scene = parse_toml(text_, file_);
  toml::table model{{"id", method.model->id}};
  for (const auto& [key, value] : method.options) model.insert_or_assign(key, value);
  scene.insert_or_assign("model", std::move(model));
  scene.insert_or_assign("integrator",
                         toml::table{{"id", method.integrator},
                                     {"formulation", name(method.formulation)},
                                     {"dt_s", 1 / (rate * substeps)},
                                     {"newton_tolerance", newton_tolerance}});
  scene.insert_or_assign("frames_1_s", rate);
  cut(scene, elements);
  name_files_in_full(scene, file_);
  return written(scene);
}

Scene SceneText::scene(const Method& method, int elements, int substeps,
                       double rate) const {
  return parse_scene(with(method, elements, substeps, rate), file_);
}

std::string SceneText::physics() const {
  toml::table scene = parse_toml(text_, file_);
  for (const std::string_view key :
       {"title", "source", "model", "integrator", "frames_1_s", "checkpoint_s"}) {
    scene.erase(key);
  }
  cut(scene, 1);
  return written(scene);
}

}  // namespace tress
