#include "simulation/scene/scene_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <new>

#include "contract/forms/teleports.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "integrators/idle_option.h"
#include "models/effects/body.h"
#include "models/effects/control_mesh.h"
#include "models/effects/strand_interaction.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {
namespace {

/// The result of `make`; the location is added to its InputErrors, which name no file.
template <class F>
auto at_place(const std::string& place, const F& make) {
  try {
    return make();
  } catch (const InputError& error) {
    refuse_at(place, error);
  } catch (const std::bad_alloc&) {
    throw InputError("not enough memory", place, "make the scene smaller");
  }
}

Effects effects_of(const Scene& scene, const ScenePlaces& places) {
  Effects all;
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    const EffectChoice& choice = scene.effects[i];
    refuse_if(scene.tables != nullptr && scene.tables->skin != nullptr &&
                  choice.parameters.knows("moves") &&
                  choice.parameters.word("moves") == "head",
              "a body that moves with the head, and roots that move with a skin",
              places.effects[i],
              "give the body poses of its own (moves = \"poses\"), or leave it fixed");
    at_place(places.effects[i], [&] {
      if (&choice.parameters == scene.interaction()) {
        StrandInteraction(choice.parameters, {});
      } else if (&choice.parameters == scene.mesh()) {
        ControlMesh(choice.parameters, segment_lengths(scene.strands));
      } else if (auto made = make_effect(scene, choice)) {
        all.push_back(std::move(made));
      }
    });
  }
  return all;
}

/// Whether the scene's method can have guides in a mesh.
void check_mesh(const Scene& scene, const ScenePlaces& places) {
  if (scene.mesh() == nullptr) return;
  const Parameters* interaction = scene.interaction();
  if (interaction != nullptr && interaction->word("coupling") == "monolithic") {
    throw InputError(
        "lagged coupling of [effects.control_mesh] needs strands that are systems of "
        "their own, not one system",
        places.integrator,
        "use coupling = \"lagged\", or leave out [effects.control_mesh]");
  }
  if (!places.tolerance.empty()) {
    throw InputError(
        "contacts of [effects.control_mesh] are found once a step, an error that no "
        "tolerance controls",
        places.tolerance, "give dt_s, or leave out [effects.control_mesh]");
  }
}

/// Whether the scene's method can have strands that rub.
void check_friction(const Scene& scene, const ScenePlaces& places) {
  if (scene.friction() == nullptr) return;
  const Parameters* interaction = scene.interaction();
  if (interaction != nullptr && interaction->word("coupling") == "monolithic") {
    throw InputError(
        "per-strand steps of [effects.strand_friction] are not available with monolithic "
        "coupling",
        places.integrator,
        "use coupling = \"lagged\", or leave out [effects.strand_friction]");
  }
  std::string able;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (!entry.impulsive) continue;
    if (entry.id == scene.integrator) return;
    able += (able.empty() ? "" : " or ") + std::string(entry.id);
  }
  throw InputError(
      fmt::format("{} does not support the contact impulses of [effects.strand_friction]",
                  scene.integrator),
      places.integrator, "use " + able);
}

/// Place of the key that an error names, or that of the method.
const std::string& place_named(const InputError& error, const ScenePlaces& places) {
  const std::string_view line = error.what();
  for (const auto& [key, place] : places.options) {
    if (line.find(key + ")") != line.npos) return place;
  }
  return places.integrator;
}

void make_once(const IntegratorEntry& entry, System& system, const Options& options,
               const ScenePlaces& places) {
  try {
    entry.make(system, options);
  } catch (const InputError& error) {
    refuse_at(place_named(error, places), error);
  } catch (const std::bad_alloc&) {
    throw InputError("not enough memory", places.integrator, "make the scene smaller");
  }
}

void check_integrator(const Scene& scene, System& system, const ScenePlaces& places) {
  const IntegratorEntry& entry = find_integrator(scene.integrator);
  const bool tied = SceneSupports(scene).any() || SceneJoints(scene).any();
  const Options options =
      tied ? options_beside_supports(system, scene.options) : scene.options;
  const std::string reason = refusal(entry, system, options.formulation);
  if (reason.empty()) {
    const Parameters& model = scene.model_options;
    if (entry.exact_jacobian && model.knows("jacobian")) {
      const std::string_view jacobian = model.word("jacobian");
      refuse_if(
          jacobian != "exact",
          fmt::format("{} with jacobian = \"{}\": an approximate Jacobian lowers its "
                      "order or makes it unstable",
                      entry.id, jacobian),
          places.model, "give [model] jacobian = \"exact\"");
    }
    make_once(entry, system, options, places);
    return;
  }
  const auto joined = [](std::string& list, std::string_view id) {
    list += (list.empty() ? "" : ", ") + std::string(id);
  };
  std::string able, forms;
  for (const IntegratorEntry& other : integrator_catalogue()) {
    if (refusal(other, system, options.formulation).empty()) joined(able, other.id);
  }
  for (const auto& [form, order] : entry.formulations) {
    if (refusal(entry, system, form).empty()) joined(forms, name(form));
  }
  throw InputError(
      fmt::format("{} cannot drive {}{} as {}{}{}", scene.integrator, scene.model->id,
                  SceneSupports(scene).any()
                      ? " with " + SceneSupports(scene).table_name()
                  : SceneJoints(scene).any() ? std::string(" with [joints]")
                                             : std::string(),
                  name(options.formulation),
                  reason.starts_with("the ") ? ", because " : ": ", reason),
      places.integrator,
      !forms.empty()  ? "give [integrator] formulation = one of: " + forms
      : !able.empty() ? "use one of: " + able
                      : "take another method: ./tress list shows what can drive what");
}

void check_options(const Scene& scene, const ScenePlaces& places) {
  for (const auto& [key, place] : places.options) {
    const std::string_view lacks = idle_option(scene, option_of(key));
    refuse_if(!lacks.empty(),
              fmt::format("{} does nothing with id = \"{}\", formulation = \"{}\"", key,
                          scene.integrator, name(scene.options.formulation)),
              place, fmt::format("leave it out, or use {}", lacks));
  }
}

/// Whether a strand of the scene can fail alone.
void check_failed_strands(const Scene& scene, const ScenePlaces& places) {
  if (scene.failed_strands == FailedStrands::end_run) return;
  const auto refuse = [&](const std::string& why, const std::string& remedy) {
    throw InputError("failed_strands = \"stay\" for " + why, places.failed_strands,
                     remedy);
  };
  const std::string leave_out = "leave out failed_strands";
  if (scene.model->on_strand == nullptr) {
    refuse(std::string(scene.model->id) + ", which is one system", leave_out);
  }
  if (scene.friction() != nullptr) {
    refuse("strands that rub, whose contacts are solved together",
           leave_out + ", or [effects.strand_friction]");
  }
  const Parameters* interaction = scene.interaction();
  if (interaction == nullptr) return;
  if (interaction->word("coupling") == "monolithic") {
    refuse("strands that are one system",
           "use [effects.strand_interaction] coupling = \"lagged\"");
  }
  if (!places.tolerance.empty()) {
    refuse("strands that touch and choose their steps, which share their intervals",
           "give dt_s instead of position_tol_rel, or " + leave_out);
  }
}

/// Makes the joined strands, and looks whether the scene's method can drive them.
void check_joints(const Scene& scene, const ScenePlaces& places,
                  const SceneJoints& joints) {
  const SceneSupports supports(scene);
  const Effects effects = effects_of(scene, places);
  for (const SceneJoints::Group& group : joints.groups()) {
    std::vector<std::unique_ptr<System>> systems;
    std::vector<const Strand*> strands;
    for (std::size_t k = group.first; k < group.first + group.count; ++k) {
      const Strand& strand = scene.strands[k];
      strands.push_back(&strand);
      auto alone = at_place(places.strands[k], [&] {
        return scene.model->on_strand(strand, scene.model_options, effects);
      });
      systems.push_back(supports.on(std::move(alone), strand, k));
    }
    const auto system = models::with_driven_bodies(
        joints.join(group, std::move(systems), strands, effects), effects);
    check_integrator(scene, *system, places);
  }
}

/// Teleports of a body with rows of its own.
std::vector<double> teleports_of(const Scene& scene, const EffectChoice& choice) {
  const Parameters& p = choice.parameters;
  if (choice.entry->id != "body" || p.word("moves") == "head") return {};
  const auto motion = models::body_motion(p, scene.head);
  return motion ? motion->teleports : std::vector<double>();
}

/// Why a strand is not carried with a root that teleports; empty: it is.
std::string not_carried(const Scene& scene, const Strand& strand, System& system) {
  if (strand.free_root) return "a strand with a free root, which stays where it is";
  if (teleports(system) == nullptr) {
    return fmt::format("{}, which cannot be carried", scene.model->id);
  }
  return {};
}

/// Why an effect cannot be carried; empty: it can.
std::string not_carried(const EffectChoice& choice) {
  const std::string_view id = choice.entry->id;
  if (id == "tether" || id == "ring") return "which holds a point at a place of its own";
  if (id == "control_mesh") return "whose links hold between steps";
  if (id == "strand_friction") return "whose impulses act between steps";
  if (driven(choice)) return "which does not jump";
  return {};
}

/// Refuses what cannot be carried with a root that teleports, and a body that teleports
/// when the root does not.
void check_teleports(const Scene& scene, const ScenePlaces& places) {
  const auto jumps = std::ranges::find_if(
      scene.strands, [](const Strand& strand) { return !strand.root.teleports.empty(); });
  const std::vector<double>& all =
      (jumps == scene.strands.end() ? scene.strands.front() : *jumps).root.teleports;
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    const std::vector<double> own = at_place(
        places.effects[i], [&] { return teleports_of(scene, scene.effects[i]); });
    std::vector<double> alone;
    std::ranges::set_difference(own, all, std::back_inserter(alone));
    refuse_if(!alone.empty(),
              fmt::format("a body that teleports at t = {:.9g} s, when the roots do not",
                          alone.empty() ? 0 : alone.front()),
              places.effects[i], "give [root] two rows of that time, or the body one");
  }
  if (all.empty()) return;
  const std::string leave_out = " or give [root] one row for each time";
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    const std::string why = not_carried(scene.effects[i]);
    refuse_if(
        !why.empty(),
        fmt::format("a root that teleports with {}, {}", scene.effects[i].entry->id, why),
        places.effects[i], "leave out the effect," + leave_out);
  }
  const Table& root = scene.tables->root;
  const std::string place = root.place("motion");
  const SceneSupports supports(scene);
  refuse_if(supports.any(),
            fmt::format("a root that teleports with {}, which act at places or times of "
                        "their own",
                        supports.any() ? supports.table_name() : ""),
            place, "leave them out," + leave_out);
  refuse_if(SceneJoints(scene).any(),
            "a root that teleports with [joints], whose ends have constraints of their "
            "own",
            place, "leave out [joints]," + leave_out);
}

}  // namespace

/// Strands that touch exchange forces once in dt_s. Gradients, supports and joints solve
/// with [integrator] linear.
std::string_view idle_option(const Scene& scene, std::string_view option) {
  const bool exchanges = scene.interaction() != nullptr || scene.friction() != nullptr ||
                         scene.mesh() != nullptr;
  const StrandTables* const tables = scene.tables.get();
  const bool solves =
      tables != nullptr &&
      (tables->gradient || !tables->supports.empty() || !tables->joints.empty());
  if ((exchanges && option == "step") || (solves && option == "linear")) return {};
  return integrators::idle_option(find_integrator(scene.integrator), scene.options,
                                  option);
}

void refuse_at(const std::string& place, const InputError& error) {
  const std::string_view line = error.what(), before_remedy = "): ";
  const std::size_t end = line.find(before_remedy);
  throw InputError(std::string(line.substr(0, end + 1)), place,
                   std::string(line.substr(end + before_remedy.size())));
}

NaturalStrains& strains_to_hold(const Scene& scene, const Strand& strand, System& system,
                                const std::string& where) {
  if (strand.free_root) {
    throw InputError("rest = \"inverse\" needs a clamped root", where,
                     "use another [root] motion, or leave out rest");
  }
  if (NaturalStrains* strains = natural_strains(system)) return *strains;
  throw InputError(
      fmt::format("rest = \"inverse\" for {}, which lacks a natural strain for each "
                  "direction in which it bends",
                  scene.model->id),
      where,
      "use super_helix, super_clothoid, articulated_chain, der, corde, xpbd_cosserat or "
      "dynamic_spline");
}

void check(const Scene& scene, const ScenePlaces& places, std::size_t strands) {
  check_options(scene, places);
  check_failed_strands(scene, places);
  if (scene.model->on_strand == nullptr && scene.rest == RestStrains::inverse) {
    throw InputError(fmt::format("rest = \"inverse\" for {}, which brings its own shape",
                                 scene.model->id),
                     places.rest, "leave out rest");
  }
  if (scene.model->on_strand == nullptr) {
    const auto system =
        at_place(places.model, [&] { return scene.model->make(scene.model_options); });
    check_integrator(scene, *system, places);
    return;
  }
  const SceneSupports supports(scene);
  const SceneJoints joints(scene);
  supports.check(scene);
  joints.check(scene);
  check_driven_bodies(scene, places.effects, strands);
  check_teleports(scene, places);
  check_friction(scene, places);
  check_mesh(scene, places);
  const Parameters* interaction = scene.interaction();
  if (scene.rest == RestStrains::inverse && interaction != nullptr &&
      interaction->word("coupling") == "monolithic") {
    throw InputError("rest = \"inverse\" for strands that are one system", places.rest,
                     "use [effects.strand_interaction] coupling = \"lagged\"");
  }
  if (!places.tolerance.empty() && interaction != nullptr &&
      interaction->word("coupling") != "monolithic" &&
      !find_integrator(scene.integrator).error_controlled) {
    throw InputError(
        fmt::format(
            "{} cannot repeat an interval between exchanges of strands that touch",
            scene.integrator),
        places.tolerance,
        "use tr_bdf2 or esdirk43, coupling = \"monolithic\", or no tolerance");
  }
  check_joints(scene, places, joints);
  const std::string* before = nullptr;
  bool driven = false;  // a strand alone
  for (std::size_t i = 0; i < scene.strands.size(); ++i) {
    const std::string& place = places.strands[i];
    const std::size_t number = places.numbers[i];
    const bool held = supports.change(number);
    // Of the same groom.
    if (before != nullptr && *before == place && !held) continue;
    const Effects effects = effects_of(scene, places);
    const auto make = [&] {
      return scene.model->on_strand(scene.strands[i], scene.model_options, effects);
    };
    auto alone = supports.on(at_place(place, make), scene.strands[i], number);
    const auto system = at_place(
        place, [&] { return models::with_driven_bodies(std::move(alone), effects); });
    if (!scene.head.teleports.empty() || !scene.strands[i].root.teleports.empty()) {
      const std::string why = not_carried(scene, scene.strands[i], *system);
      refuse_if(!why.empty(), "a root that teleports with " + why, place,
                "give the strand a clamped root, or [root] one row for each time");
    }
    if (joints.of(number) == nullptr && (!driven || held)) {
      check_integrator(scene, *system, places);
      driven = true;
    }
    if (scene.rest == RestStrains::inverse) {
      strains_to_hold(scene, scene.strands[i], *system, places.rest);
    }
    before = &place;
  }
}

}  // namespace tress::simulation
