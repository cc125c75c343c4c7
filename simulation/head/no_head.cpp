#include "simulation/head/no_head.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/head/head.h"
#include "simulation/run/world.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {
namespace {

/// An option of the model that heads do not have.
NoHead no_option(const Parameters& p, const char* key, std::string remedy) {
  return {fmt::format("{} = \"{}\" does not come as a head", key, p.word(key)),
          std::move(remedy)};
}

/// Whether steps are solved with all derivatives of the residual.
bool has_exact_tangent(const Scene& scene) {
  const auto method = head_method(scene);
  return method && *method != models::HeadMethod::semi_implicit_euler;
}

/// The tangent of the scene's method: all derivatives, or `of_one` for one correction.
std::optional<NoHead> no_tangent(const Scene& scene, const char* of_one) {
  const bool exact = has_exact_tangent(scene);
  const std::string needed = exact ? "exact" : of_one;
  if (scene.model_options.word("tangent") == needed) return {};
  return no_option(scene.model_options, "tangent",
                   fmt::format("give [model] tangent = \"{}\"{}", needed,
                               exact ? " to " + scene.integrator
                                     : ", or [integrator] id = \"backward_euler\""));
}

std::optional<NoHead> no_springs(const Scene& scene) {
  const Parameters& p = scene.model_options;
  if (p.word("bending") != "angular") {
    return no_option(p, "bending", "give [model] bending = \"angular\"");
  }
  if (p.word("torsion") != "none") {
    return no_option(p, "torsion", "give [model] torsion = \"none\"");
  }
  return no_tangent(scene, "filtered");
}

std::optional<NoHead> no_model(const Scene& scene) {
  const Parameters& p = scene.model_options;
  if (steps_springs(scene)) return no_springs(scene);
  if (scene.model->id != "super_helix" && !steps_chains(scene)) {
    return NoHead{fmt::format("{} does not come as a head", scene.model->id),
                  "use [model] id = \"super_helix\", \"articulated_chain\" or "
                  "\"mass_spring\""};
  }
  if (p.word("modes") == "bend_planar") {
    return NoHead{"strands of a head bend in both directions",
                  "give [model] modes = \"bend_twist\" or \"bend\""};
  }
  if (auto no = no_tangent(scene, "stiff")) return no;
  if (scene.integrator == "tr_bdf2" && p.word("modes") == "bend_twist" &&
      p.word("rotary_inertia") == "off") {
    return NoHead{
        "a head by tr_bdf2 starts from an acceleration, which twist without "
        "inertia does not have",
        "give [model] rotary_inertia = \"on\" or modes = \"bend\""};
  }
  if (p.word("solver") != "recursive") {
    return no_option(p, "solver", "leave out [model] solver");
  }
  if (p.whole("quadrature") == 1 || p.whole("quadrature") > 16) {
    return NoHead{fmt::format("{} points of an element", p.whole("quadrature")),
                  "give [model] quadrature = 0, or 2 to 16"};
  }
  return {};
}

std::optional<NoHead> no_method(const Scene& scene) {
  if (!head_method(scene)) {
    return NoHead{fmt::format("{} does not step a head", scene.integrator),
                  "use [integrator] id = \"semi_implicit_euler\", "
                  "\"linearly_implicit_midpoint\", \"backward_euler\" or "
                  "\"tr_bdf2\""};
  }
  if (has_exact_tangent(scene) && scene.options.refresh != Refresh::every_iteration) {
    return NoHead{"heads have a new matrix in every iteration",
                  "leave out [integrator] refresh"};
  }
  if (scene.rest == RestStrains::inverse) {
    return NoHead{"strands of a head have the natural strains of their tables",
                  "leave out rest = \"inverse\""};
  }
  const Options& options = scene.options;
  if (options.max_work > 0) {
    return NoHead{"a head does not count its work", "leave out [integrator] max_work"};
  }
  if (options.tolerance > 0) {
    if (options.max_steps == Options{}.max_steps) return {};
    return NoHead{"strands of a head that choose their steps are not stopped after some",
                  "give [integrator] min_step_s instead of max_steps"};
  }
  if (1 / scene.frame_rate / options.step > static_cast<double>(options.max_steps)) {
    return NoHead{"more than max_steps steps of dt_s from frame to frame",
                  "give a longer dt_s, or more frames_1_s"};
  }
  return {};
}

std::optional<NoHead> no_strands(const Scene& scene) {
  const std::vector<StrandSource>& sources = scene.tables->sources;
  const int elements = sources.front().table.values().whole("elements");
  for (const StrandSource& source : sources) {
    const Parameters& p = source.table.values();
    if (p.whole("elements") != elements) {
      return NoHead{
          fmt::format("strands of {} and of {} elements", elements, p.whole("elements")),
          "give all equally many elements"};
    }
    if (source.groom && p.whole("guides") > 0) {
      return NoHead{"all strands of a head are simulated", "leave out guides"};
    }
    if (source.file && p.word("cuts") != "equal") {
      return NoHead{"elements of different lengths", "give [groom] cuts = \"equal\""};
    }
    if (p.number("grading") != 1) {
      return NoHead{"elements of different lengths", "leave out grading"};
    }
  }
  if (scene.strands.front().free_root) {
    return NoHead{"free roots", "use another [root] motion"};
  }
  return {};
}

/// Heads with bodies alone, beside what all heads have; empty: it is no such head.
std::string only_with_bodies(const Scene& scene) {
  if (steps_springs(scene)) return "a head of springs";
  return has_exact_tangent(scene) ? "a head by " + scene.integrator : "";
}
std::string with_others(const Scene& scene) {
  return steps_springs(scene) ? "leave it out, or use [model] id = \"super_helix\""
                              : "leave it out, or use [integrator] id = "
                                "\"semi_implicit_euler\"";
}

std::optional<NoHead> no_effects(const Scene& scene) {
  const std::string bodies = only_with_bodies(scene);
  for (const EffectChoice& choice : scene.effects) {
    const auto effect = make_effect(scene, choice);
    if (effect != nullptr) {
      if (auto no = models::refused_by_heads(*effect))
        return NoHead{no->reason, no->remedy};
      if (!bodies.empty() && !effect->uniform_acceleration() && !effect->viscosity() &&
          effect->rigid_contact() == nullptr) {
        return NoHead{fmt::format("[effects.{}] on {}", choice.entry->id, bodies),
                      with_others(scene)};
      }
    } else if (!bodies.empty() && &choice.parameters == scene.interaction()) {
      return NoHead{"interaction on " + bodies, with_others(scene)};
    } else if (&choice.parameters != scene.interaction()) {
      return NoHead{fmt::format("a head does not know [effects.{}]", choice.entry->id),
                    "leave it out"};
    } else if (choice.parameters.word("coupling") == "monolithic") {
      return NoHead{"strands of a head are no system of one",
                    "give [effects.strand_interaction] coupling = \"lagged\""};
    }
  }
  return {};
}

}  // namespace

bool steps_springs(const Scene& scene) { return scene.model->id == "mass_spring"; }
bool steps_chains(const Scene& scene) { return scene.model->id == "articulated_chain"; }

std::optional<models::HeadMethod> head_method(const Scene& scene) {
  for (const auto& [id, method] : head_methods) {
    if (scene.integrator == id) return method;
  }
  return {};
}

std::optional<NoHead> no_head(const SceneOutline& outline, models::HeadNumber number) {
  const Scene& scene = outline.scene;
  if (scene.strands.empty()) {
    return NoHead{fmt::format("{} brings its own geometry", scene.model->id),
                  "use [model] id = \"super_helix\""};
  }
  if (auto no = no_model(scene)) return no;
  if (steps_springs(scene) && number != models::HeadNumber::float64) {
    return NoHead{"springs in 32 bits, which do not resolve their strains",
                  "give --bits 64"};
  }
  if (steps_chains(scene) && scene.integrator == "linearly_implicit_midpoint" &&
      number != models::HeadNumber::float64) {
    return NoHead{
        "rigid links in 32 bits, whose rounding a single correction does not mend",
        "give --bits 64, or [integrator] id = \"tr_bdf2\""};
  }
  if (auto no = no_method(scene)) return no;
  const double tolerance = scene.options.tolerance;
  if (tolerance > 0 && !models::resolve(number, tolerance)) {
    const bool narrow = number == models::HeadNumber::float32;
    return NoHead{
        fmt::format("tolerance = {:g} in {} bits, which do not resolve it", tolerance,
                    narrow ? 32 : 64),
        narrow ? "give --bits 64, or a larger tolerance" : "give a larger tolerance"};
  }
  if (auto no = no_strands(scene)) return no;
  return no_effects(scene);
}

}  // namespace tress::simulation
