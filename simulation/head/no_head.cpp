#include "simulation/head/no_head.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/head/head.h"
#include "simulation/run/world.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_table.h"
#include "simulation/table/along.h"

namespace tress::simulation {
namespace {

/// An option of the model that lanes do not have.
NoHead no_option(const Parameters& p, const char* key, std::string remedy) {
  return {fmt::format("{} = \"{}\"", key, p.word(key)), std::move(remedy),
          std::string("model.") + key};
}

/// Whether steps are solved with all derivatives of the residual.
bool has_exact_tangent(const Scene& scene) {
  const auto method = head_method(scene);
  return method && *method != HeadMethod::linearly_implicit_euler;
}

/// Whether lanes support an effect only in a step of one correction.
bool needs_one_correction(const Scene& scene, const EffectChoice& choice) {
  const auto effect = make_effect(scene, choice);
  return effect == nullptr ||
         (models::depends_on_place(*effect) && effect->rigid_contact() == nullptr);
}

/// The Jacobian of the scene's method: all derivatives, or `of_one` for one correction.
std::optional<NoHead> no_jacobian(const Scene& scene, const char* of_one) {
  const bool exact = has_exact_tangent(scene);
  const std::string_view needed = exact ? "exact" : of_one,
                         given = scene.model_options.word("jacobian");
  if (given == needed) return {};
  const bool other = std::ranges::any_of(scene.effects, [&](const EffectChoice& choice) {
    return needs_one_correction(scene, choice);
  });
  return NoHead{fmt::format("jacobian = \"{}\" with {}", given, scene.integrator),
                fmt::format("give [model] jacobian = \"{}\"{}", needed,
                            exact   ? " to " + scene.integrator
                            : other ? ""
                                    : ", or [integrator] id = \"backward_euler\""),
                "model.jacobian"};
}

std::optional<NoHead> no_integrator(const Scene& scene) {
  if (head_method(scene)) return {};
  return NoHead{scene.integrator,
                "use [integrator] id = \"linearly_implicit_euler\", "
                "\"linearly_implicit_midpoint\", \"backward_euler\" or "
                "\"tr_bdf2\"",
                "integrator.id"};
}

/// An option of the model that lanes have with this word only.
std::optional<NoHead> no_other(const Parameters& p, const char* key,
                               std::string_view word) {
  if (p.word(key) == word) return {};
  return no_option(p, key, fmt::format("give [model] {} = \"{}\"", key, word));
}

/// Lanes eliminate along the strand.
std::optional<NoHead> no_solver(const Parameters& p) {
  if (p.word("solver") == "auto") return {};
  return no_option(p, "solver", "leave out [model] solver");
}

std::optional<NoHead> no_springs(const Scene& scene) {
  const Parameters& p = scene.model_options;
  if (auto no = no_integrator(scene)) return no;
  if (auto no = no_other(p, "bending", "angular")) return no;
  if (auto no = no_other(p, "torsion", "none")) return no;
  if (auto no = no_solver(p)) return no;
  return no_jacobian(scene, "filtered");
}

std::optional<NoHead> no_rods(const Scene& scene) {
  const Parameters& p = scene.model_options;
  if (auto no = no_integrator(scene)) return no;
  if (auto no = no_other(p, "stretch", "extensible")) return no;
  if (auto no = no_other(p, "twist", "dynamic")) return no;
  if (auto no = no_solver(p)) return no;
  // Lanes leave out how friction changes with lengthening (DerForces::ByLengthening):
  // iterations mend that, a single correction does not.
  if (scene.integrator == "linearly_implicit_midpoint") {
    return NoHead{
        "der by linearly_implicit_midpoint, whose single correction needs "
        "all derivatives of the internal friction",
        "use [integrator] id = \"linearly_implicit_euler\" or "
        "\"backward_euler\"",
        "integrator.id"};
  }
  return no_jacobian(scene, "elastic");
}

std::optional<NoHead> no_quaternions(const Scene& scene) {
  const Parameters& p = scene.model_options;
  if (auto no = no_other(p, "coordinates", "quaternion")) return no;
  if (auto no = no_integrator(scene)) return no;
  // Long steps of a motion that is not smooth have several solutions, and a lane has
  // fewer ways to stay on one of them than a strand by itself.
  if (scene.options.tolerance > 0) {
    return NoHead{fmt::format("{} with a tolerance, in whose long steps lanes find no "
                              "solution",
                              scene.model->id),
                  "give [integrator] dt_s instead of position_tol_rel",
                  "integrator.position_tol_rel"};
  }
  if (scene.integrator == "tr_bdf2" && scene.model->id == "xpbd_cosserat") {
    return NoHead{
        "tr_bdf2 on xpbd_cosserat, in whose long steps lanes leave the solution",
        "use [integrator] id = \"backward_euler\"", "integrator.id"};
  }
  if (has_exact_tangent(scene)) return {};
  return NoHead{fmt::format("{} with an exact Jacobian", scene.integrator),
                "use [integrator] id = \"backward_euler\"", "integrator.id"};
}

std::optional<NoHead> no_model(const Scene& scene) {
  const Parameters& p = scene.model_options;
  if (steps_springs(scene)) return no_springs(scene);
  if (steps_rods(scene)) return no_rods(scene);
  if (steps_quaternions(scene)) return no_quaternions(scene);
  if (scene.model->id != "super_helix" && !steps_chains(scene) &&
      !steps_clothoids(scene)) {
    return NoHead{std::string(scene.model->id),
                  "use [model] id = \"super_helix\", \"super_clothoid\", "
                  "\"articulated_chain\", \"mass_spring\", \"der\", \"corde\" or "
                  "\"xpbd_cosserat\"",
                  "model.id"};
  }
  if (auto no = no_integrator(scene)) return no;
  if (p.word("modes") == "bend_planar") {
    return no_option(p, "modes", "give [model] modes = \"bend_twist\" or \"bend\"");
  }
  if (auto no = no_jacobian(scene, "elastic")) return no;
  if (scene.integrator == "tr_bdf2" && p.word("modes") == "bend_twist" &&
      p.word("rotary_inertia") == "off") {
    return NoHead{
        "tr_bdf2 and twist without inertia, whose acceleration at the start is unknown",
        "give [model] rotary_inertia = \"on\" or modes = \"bend\"",
        "model.rotary_inertia"};
  }
  if (p.word("solver") != "recursive") {
    return no_option(p, "solver", "leave out [model] solver");
  }
  if (p.whole("quadrature") == 1 || p.whole("quadrature") > 16) {
    return NoHead{fmt::format("{} points of an element", p.whole("quadrature")),
                  "give [model] quadrature = 0, or 2 to 16", "model.quadrature"};
  }
  return {};
}

std::optional<NoHead> no_method(const Scene& scene) {
  if (has_exact_tangent(scene) && scene.options.refresh != Refresh::every_iteration) {
    return NoHead{"kept matrices", "leave out [integrator] refresh",
                  "integrator.refresh"};
  }
  if (scene.rest == RestStrains::inverse) {
    return NoHead{"rest = \"inverse\"", "leave out rest", "rest"};
  }
  const Options& options = scene.options;
  if (options.max_work > 0) {
    return NoHead{"max_work", "leave out [integrator] max_work", "integrator.max_work"};
  }
  if (options.tolerance > 0 && options.max_steps != Options{}.max_steps) {
    return NoHead{"max_steps with a tolerance",
                  "give [integrator] min_step_s instead of max_steps",
                  "integrator.max_steps"};
  }
  return {};
}

std::optional<NoHead> no_strands(const Scene& scene) {
  const std::span<const StrandSource> sources =
      scene.tables == nullptr ? std::span<const StrandSource>() : scene.tables->sources;
  for (const StrandSource& source : sources) {
    const Parameters& p = source.table.values();
    if (source.file && p.word("mesh") != "equal") {
      return NoHead{"elements of different lengths", "give [groom] mesh = \"equal\"", "",
                    source.table.place("mesh")};
    }
    if (p.number("grading") != 1) {
      return NoHead{"elements of different lengths", "leave out grading", "",
                    source.table.place("grading")};
    }
    if (const std::string_view key = varied_key(source.table); !key.empty()) {
      return NoHead{"a section or material that varies along the strand",
                    "leave out widths, and the keys that end with _along", "",
                    source.table.place(key)};
    }
  }
  if (scene.tables != nullptr && scene.tables->skin != nullptr) {
    return NoHead{"roots that move with a skin, each in its own way",
                  "use another [root] motion", "root.motion"};
  }
  if (!scene.strands.front().root.teleports.empty()) {
    return NoHead{"roots that teleport", "leave out rows with the same time",
                  "root.motion"};
  }
  if (scene.strands.front().free_root) {
    return NoHead{"free roots", "use another [root] motion", "root.motion"};
  }
  return {};
}

/// Returns the effects of lanes that support bodies only, beyond those that all lanes
/// support; empty: there are others.
std::string only_with_bodies(const Scene& scene) {
  if (steps_edges(scene)) return std::string(scene.model->id);
  return has_exact_tangent(scene) ? scene.integrator : "";
}
std::string with_others(const Scene& scene) {
  return std::string("leave it out, or use [model] ") +
         (steps_edges(scene) ? "id = \"super_helix\" with " : "") +
         "jacobian = \"elastic\" and [integrator] id = \"linearly_implicit_euler\"";
}

std::optional<NoHead> no_effects(const Scene& scene) {
  const std::string bodies = only_with_bodies(scene);
  for (const EffectChoice& choice : scene.effects) {
    const auto effect = make_effect(scene, choice);
    const std::string key = fmt::format("effects.{}", choice.entry->id);
    if (effect != nullptr) {
      if (auto no = models::refused_by_heads(*effect)) {
        return NoHead{fmt::format("[effects.{}], as {}", choice.entry->id, no->reason),
                      "leave it out", key};
      }
      if (steps_rods(scene) && !has_exact_tangent(scene) &&
          effect->rigid_contact() != nullptr &&
          choice.parameters.number("friction") > 0) {
        return NoHead{fmt::format("[effects.{}] with friction on der by {}, whose single "
                                  "correction needs all derivatives of the friction",
                                  choice.entry->id, scene.integrator),
                      "give friction = 0, or use [integrator] id = \"backward_euler\"",
                      key};
      }
      if (!bodies.empty() && needs_one_correction(scene, choice)) {
        return NoHead{fmt::format("[effects.{}] with {}", choice.entry->id, bodies),
                      with_others(scene), key};
      }
    } else if (!bodies.empty()) {
      return NoHead{"[effects.strand_interaction] with " + bodies, with_others(scene),
                    key};
    }
  }
  return {};
}

std::optional<NoHead> no_number(const Scene& scene, models::HeadNumber number) {
  const bool narrow = number == models::HeadNumber::float32;
  if (narrow && steps_springs(scene)) {
    return NoHead{"springs in single precision, which does not resolve their strains",
                  "give --precision 64"};
  }
  if (narrow && (steps_chains(scene) || steps_quaternions(scene)) &&
      scene.integrator == "linearly_implicit_midpoint") {
    return NoHead{fmt::format("{} in 32 bits, whose rounding a single correction does "
                              "not mend",
                              steps_chains(scene) ? "rigid links" : scene.model->id),
                  "give --precision 64, or [integrator] id = \"tr_bdf2\""};
  }
  const double tolerance = scene.options.tolerance;
  if (tolerance == 0 || resolve(number, tolerance)) return {};
  return NoHead{
      fmt::format("position_tol_rel = {:g} in {} bits, which do not resolve it",
                  tolerance, narrow ? 32 : 64),
      narrow ? "give --precision 64, or a larger tolerance" : "give a larger tolerance",
      "integrator.position_tol_rel"};
}

}  // namespace

bool steps_springs(const Scene& scene) { return scene.model->id == "mass_spring"; }
bool steps_quaternions(const Scene& scene) {
  return scene.model->id == "corde" || scene.model->id == "xpbd_cosserat";
}
bool steps_rods(const Scene& scene) { return scene.model->id == "der"; }
bool steps_edges(const Scene& scene) {
  return steps_springs(scene) || steps_rods(scene) || steps_quaternions(scene);
}
bool steps_chains(const Scene& scene) { return scene.model->id == "articulated_chain"; }
bool steps_clothoids(const Scene& scene) { return scene.model->id == "super_clothoid"; }

std::optional<HeadMethod> head_method(const Scene& scene) {
  for (const auto& [id, method] : head_methods) {
    if (scene.integrator == id) return method;
  }
  return {};
}

std::optional<NoHead> no_lanes(const Scene& scene, models::HeadNumber number) {
  if (const SceneSupports supports(scene); supports.any()) {
    return NoHead{supports.table_name(), "leave out " + supports.table_name(),
                  "supports"};
  }
  if (auto no = no_model(scene)) return no;
  if (auto no = no_method(scene)) return no;
  if (auto no = no_number(scene, number)) return no;
  if (auto no = no_strands(scene)) return no;
  return no_effects(scene);
}

}  // namespace tress::simulation
