#include "experiments/calibrate/specimen.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "models/strand/strand_parameters.h"
#include "simulation/run/world.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::calibrate {
namespace {

constexpr const char* drag_id = "linear_drag";

auto drag_of(auto& scene) {
  return std::ranges::find(scene.effects, drag_id,
                           [](const EffectChoice& one) { return one.entry->id; });
}

Scene with_properties(Scene scene, const Properties& properties) {
  Material& material = scene.strands.front().material;
  material.internal_friction = properties.gamma;
  material.shear_modulus *= properties.youngs_modulus / material.youngs_modulus;
  material.youngs_modulus = properties.youngs_modulus;
  scene.tables.reset();
  auto drag = drag_of(scene);
  if (drag == scene.effects.end()) {
    const EffectEntry& entry = find_effect(drag_id, "effects");
    Parameters none(entry.parameters, "effects.linear_drag");
    drag = scene.effects.insert(drag, EffectChoice{&entry, std::move(none)});
  }
  drag->parameters.set(drag_key, fmt::format("{}", properties.nu));
  return scene;
}

}  // namespace

Specimen specimen(const ModelEntry& model, const Parameters& parameters) {
  const Strand made = strand(parameters);
  const auto build = [&model, parameters](const Properties& properties, int finer) {
    Parameters p = parameters;
    p.set(gamma_key, fmt::format("{}", properties.gamma));
    p.set(drag_key, fmt::format("{}", properties.nu));
    p.set(stiffness_key, fmt::format("{}", properties.youngs_modulus));
    const double ratio = properties.youngs_modulus / parameters.number(stiffness_key);
    const double shear = ratio * parameters.number("shear_modulus_pa");
    if (shear > 0) p.set("shear_modulus_pa", fmt::format("{}", shear));  // 0: not given
    p.set("elements", fmt::format("{}", finer * p.whole("elements")));
    return BuiltStrand{model.make(p), guarded_strands(model, p)};
  };
  return {{parameters.number(gamma_key), parameters.number(drag_key),
           parameters.number(stiffness_key)},
          made.length(),
          made.mass(),
          build};
}

Specimen specimen(const Scene& scene) {
  const std::string where = "scene " + scene.name;
  if (scene.strands.empty()) {
    throw InputError("the model brings its own geometry: it has no tip to be followed",
                     where, "give a scene with one [strand]");
  }
  if (scene.strands.size() > 1) {
    throw InputError(
        fmt::format("{} strands, but records are of one", scene.strands.size()), where,
        "leave one [strand] in it");
  }
  if (simulation::SceneJoints(scene).any()) {
    throw InputError("the strand has joints: its tip does not swing about a root", where,
                     "leave out [joints]");
  }
  if (const simulation::SceneSupports supports(scene); supports.any()) {
    throw InputError(
        supports.table_name() + ": the tip does not swing freely about a root", where,
        "leave out " + supports.table_name());
  }
  const Strand& strand = scene.strands.front();
  if (strand.free_root) {
    throw InputError("the strand flies freely: its tip does not swing about a root",
                     where, "clamp it: leave out motion = \"free\"");
  }
  const auto build = [scene](const Properties& properties, int finer) {
    Scene changed = with_properties(scene, properties);
    for (; finer > 1; finer /= 2) changed = refined(std::move(changed));
    const Strand& made = changed.strands.front();
    const Effects effects = make_effects(changed);
    return BuiltStrand{changed.model->on_strand(made, changed.model_options, effects),
                       {guarded_strand(made, effects)}};
  };
  const auto drag = drag_of(scene);
  const double nu = drag == scene.effects.end() ? 0 : drag->parameters.number(drag_key);
  const Material& material = strand.material;
  return {{material.internal_friction, nu, material.youngs_modulus},
          strand.length(),
          strand.mass(),
          build};
}

}  // namespace tress::experiments::calibrate
