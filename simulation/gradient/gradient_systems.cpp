#include "simulation/gradient/gradient_systems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "contract/forms/constraint_form.h"
#include "contract/forms/material_points.h"
#include "contract/input_error.h"
#include "contract/jacobian_choice.h"
#include "models/joints/joined_system.h"
#include "models/strand_copies.h"
#include "simulation/rest/supported_start.h"
#include "simulation/run/strand_maker.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_changes/strand_options.h"

namespace tress::simulation {
namespace {

using integrators::RunParameter;

/// The model's options of a strand.
Parameters options_of(const Scene& scene, std::size_t strand) {
  return StrandOptions(scene).of(scene.strands[strand]);
}

/// Sets the exact Jacobian.
Parameters exact(const Scene& scene, Parameters options) {
  for (const Parameter& p : scene.model->parameters) {
    if (p.name == jacobian_parameter.name) {
      options.set(p.name, words_of(jacobian_parameter.choices).front());
    }
  }
  return options;
}

void check_start_on_supports(const SupportedStart& start, const std::string& place) {
  refuse_if(start.steps > 0,
            "no gradient of a strand that begins off its supports: derivatives of the "
            "search for a start on them are not available",
            place, "give the strand a shape that begins on its supports");
}

/// The strands of a group as World makes them.
std::unique_ptr<System> joined_system(const Scene& scene,
                                      const SceneJoints::Group& group) {
  const StrandMaker maker(scene);
  std::vector<StrandToMake> strands;
  for (std::size_t k = group.first; k < group.first + group.count; ++k) {
    strands.push_back({.strand = scene.strands[k], .number = k});
  }
  SteppedSystem made = maker.joined(strands, group);
  check_start_on_supports(made.supported, maker.joints().place());
  return std::move(made.system);
}

/// The model of a strand with its supports.
std::unique_ptr<System> on_supports(const Scene& scene, std::size_t strand,
                                    const Parameters& model_options) {
  const Strand& one = scene.strands[strand];
  const SceneSupports supports(scene);
  auto system = supports.on(
      scene.model->on_strand(one, model_options, make_effects(scene)), one, strand);
  if (!supports.hold(strand) || !supports.constrain()) return system;
  const std::string& place = supports.place(strand);
  check_start_on_supports(begin_on_supports(*system, place), place);
  return system;
}

/// The location of what holds a strand rigidly; empty: nothing does.
std::string rigid_place(const Scene& scene, std::size_t strand) {
  const SceneJoints joints(scene);
  if (const auto* group = joints.of(strand)) return joints.places(*group).front();
  const SceneSupports supports(scene);
  return supports.hold(strand) && supports.constrain() ? supports.place(strand) : "";
}

/// Of a parameter that places something. Hair at rest sinks into a compliant body by 6e-5
/// of its length, and the differences must not take points into or out of contact.
/// Positions are rounded at 1e-16 of the length, frames several times at 1e-16.
double distance_of_places(const Scene& scene, std::size_t strand,
                          const SceneParameter& parameter) {
  constexpr double part_of_length = 2e-8, turn = 1e-7;  // turn: rad
  const bool turns = parameter.unit == "rad";
  const double change = turns ? turn : part_of_length * scene.strands[strand].length();
  return std::min(integrators::central_distance, change / parameter.measure);
}

/// The constraints of a system at its start.
std::vector<double> gap_at_start(System& system) {
  std::vector<double> q(static_cast<std::size_t>(system.layout().coordinates)), v(q),
      g(static_cast<std::size_t>(system.layout().constraints));
  system.initial_state(q, v);
  const Status s = system.constraint_form()->value(0, q, g);
  if (s != Status::ok) g.assign(g.size(), std::nan(""));
  return g;
}

}  // namespace

std::unique_ptr<System> system_of(const Scene& scene, std::size_t strand) {
  const SceneJoints joints(scene);
  if (const auto* group = joints.of(strand)) return joined_system(scene, *group);
  return on_supports(scene, strand, options_of(scene, strand));
}

std::unique_ptr<System> exact_system_of(const Scene& scene, std::size_t strand) {
  const SceneJoints joints(scene);
  const auto* const group = joints.of(strand);
  if (group == nullptr) {
    return on_supports(scene, strand, exact(scene, options_of(scene, strand)));
  }
  Scene changed = scene;
  changed.model_options = exact(scene, scene.model_options);
  auto system = joined_system(changed, *group);
  dynamic_cast<models::JoinedSystem&>(*system).be_exact();
  return system;
}

PointRange points_of(const Scene& scene, std::size_t strand) {
  const SceneJoints joints(scene);
  const auto* const group = joints.of(strand);
  if (group == nullptr) {
    const auto system = system_of(scene, strand);
    return {0, static_cast<std::size_t>(system->material_points()->count())};
  }
  const auto count = [&](std::size_t k) { return scene.strands[k].segments.size() + 1; };
  std::size_t first = 0;
  for (std::size_t k = group->first; k < strand; ++k) first += count(k);
  return {first, count(strand)};
}

integrators::KnownForces known_forces(const Scene& scene) {
  const models::Effects effects = make_effects(scene);
  return {.sparse = !needs(effects).couplings, .quadratic = !depend_on_place(effects)};
}

std::unique_ptr<System> copies_of(const Scene& scene, std::size_t strand) {
  if (SceneSupports(scene).change(strand) || SceneJoints(scene).of(strand) != nullptr) {
    return nullptr;
  }
  return models::strand_copies(*scene.model, scene.strands[strand],
                               options_of(scene, strand), make_effects(scene));
}

std::vector<RunParameter> run_parameters(const Scene& scene, std::size_t strand,
                                         std::span<const SceneParameter> parameters) {
  std::vector<RunParameter> all;
  for (const SceneParameter& parameter : parameters) {
    all.emplace_back([&scene, strand, &parameter](double s) {
      Scene changed = scene;
      parameter.change(changed, s);
      return exact_system_of(changed, strand);
    });
    all.back().name = parameter.name;
    all.back().law = parameter.law;
    // Supports and effects may hold what they find at the start.
    all.back().starts = parameter.starts && !SceneSupports(scene).change(strand) &&
                        SceneJoints(scene).of(strand) == nullptr &&
                        known_forces(scene).quadratic;
    if (parameter.places) {
      all.back().places = distance_of_places(scene, strand, parameter);
    }
  }
  return all;
}

void check_starts(const Scene& scene, std::size_t strand, System& system,
                  std::span<const SceneParameter> parameters) {
  const std::string place = rigid_place(scene, strand);
  if (place.empty() || system.constraint_form() == nullptr) return;
  // A thousandth of a length, or of a radian, against rounding.
  constexpr double change = 1e-3, moved = 1e-9;
  const std::vector<double> here = gap_at_start(system);
  for (const SceneParameter& parameter : parameters) {
    Scene changed = scene;
    parameter.change(changed, change);
    bool off = false;
    try {
      const std::vector<double> there = gap_at_start(*exact_system_of(changed, strand));
      for (std::size_t i = 0; i < here.size(); ++i) {
        off = off || !(std::abs(there[i] - here[i]) <= moved);
      }
    } catch (const InputError&) {  // a search would lead it there
      off = true;
    }
    if (!off) continue;
    const bool joined = SceneJoints(scene).any();
    refuse_gradient(
        parameter.name,
        fmt::format("it takes the strand off its {} at the start",
                    joined ? "joints or rigid supports" : "rigid supports"),
        place,
        joined ? "leave it out" : "leave it out, or give [supports] stiffness_n_per_m");
  }
}

}  // namespace tress::simulation
