#include <fmt/format.h>

#include <string>
#include <vector>

#include "contract/input_error.h"
#include "integrators/gradient/adjoint_run.h"
#include "integrators/gradient/gradient_run.h"
#include "simulation/gradient/contact_at_stops.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {
namespace {

std::vector<std::string> effects_between_strands(const Scene& scene) {
  std::vector<std::string> all;
  for (const EffectChoice& one : scene.effects) {
    const Parameters* const own = &one.parameters;
    if (own == scene.interaction() || own == scene.friction() || own == scene.mesh()) {
      all.push_back(fmt::format("[effects.{}]", one.entry->id));
    }
  }
  return all;
}

}  // namespace

void check_gradient(const Scene& scene) {
  refuse_if(scene.model->on_strand != nullptr && !scene.tables->gradient,
            fmt::format("scene {} has no [gradient]", scene.name), "--gradient",
            "add [gradient] by = [\"youngs_modulus_pa\"] to it");
  check_derivatives(scene);
  const std::string way(scene.tables->gradient->values().word("way"));
  if (gradient_way(way) != GradientWay::adjoint) return;
  const std::string reason = integrators::no_adjoint(*exact_system_of(scene, 0),
                                                     scene.integrator, scene.options);
  refuse_if(!reason.empty(), "no adjoint: " + reason, scene.tables->gradient->place(),
            "use way = \"auto\"");
}

std::string gradient_place(const Scene& scene) {
  const bool has_table = scene.tables != nullptr && scene.tables->gradient;
  return has_table ? scene.tables->gradient->place() : "scene " + scene.name;
}

void check_derivatives(const Scene& scene) {
  const std::string place = gradient_place(scene);
  refuse_if(scene.model->on_strand == nullptr,
            fmt::format("gradients are of strands, and {} brings its own shape",
                        scene.model->id),
            place, "use a scene with [strand] or [groom]");
  refuse_if(scene.strands_touch(),
            "no gradient of strands that touch: each is differentiated by itself", place,
            fmt::format("leave out {}", fmt::join(effects_between_strands(scene), ", ")));
  refuse_if(scene.rest == RestStrains::inverse,
            "no gradient with rest = \"inverse\", whose natural strains follow from the "
            "parameters",
            place, "leave out rest = \"inverse\"");
  refuse_if(
      !scene.strands.front().root.teleports.empty(),
      "no gradient of a strand whose root teleports: derivatives leave out the jump",
      place, "give [root] one row for each time");
  refuse_if(
      has_driven_bodies(scene),
      "no gradient of a strand that drives a body: derivatives of the body's motion "
      "are not implemented",
      place, "use another motion of [effects.body] than moves = \"turns\" or \"free\"");
  const SceneSupports supports(scene);
  const SceneJoints joints(scene);
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    // Others are as the first one.
    if (k > 0 && !supports.hold(k) && joints.beginning_with(k) == nullptr) continue;
    const auto system = exact_system_of(scene, k);
    const auto no = integrators::no_gradient(
        scene.integrator, *system, options_beside_supports(*system, scene.options));
    if (no) throw InputError("no gradient: " + no->reason, place, no->remedy);
  }
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    refuse_if(
        begins_inside(scene, k),
        fmt::format("no gradient: strand {} begins inside a body with exact contact", k),
        place, "move the body or the strand");
  }
}

}  // namespace tress::simulation
