#include "simulation/gradient/gradient_systems.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "contract/forms/constraint_form.h"
#include "contract/input_error.h"
#include "contract/jacobian_choice.h"
#include "models/strand_copies.h"
#include "simulation/rest/supported_start.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_changes/strand_options.h"

namespace tress::simulation {
namespace {

using integrators::RunParameter;

/// The model's options of a strand.
Parameters options_of(const Scene& scene, std::size_t strand) {
  return StrandOptions(scene).of(scene.strands[strand]);
}

/// The same with the exact Jacobian.
Parameters exact_options(const Scene& scene, std::size_t strand) {
  Parameters options = options_of(scene, strand);
  for (const Parameter& p : scene.model->parameters) {
    if (p.name == jacobian_parameter.name) {
      options.set(p.name, words_of(jacobian_parameter.choices).front());
    }
  }
  return options;
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
  refuse_if(begin_on_supports(*system, place).steps > 0,
            "no gradient of a strand that begins off its supports: derivatives of the "
            "search for a start on them are not available",
            place, "give the strand a shape that begins on its supports");
  return system;
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
  return on_supports(scene, strand, options_of(scene, strand));
}

std::unique_ptr<System> exact_system_of(const Scene& scene, std::size_t strand) {
  return on_supports(scene, strand, exact_options(scene, strand));
}

integrators::KnownForces known_forces(const Scene& scene) {
  const models::Effects effects = make_effects(scene);
  return {.sparse = !needs(effects).couplings, .quadratic = !depend_on_place(effects)};
}

std::unique_ptr<System> copies_of(const Scene& scene, std::size_t strand) {
  if (SceneSupports(scene).change(strand)) return nullptr;
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
                        known_forces(scene).quadratic;
    if (parameter.places) {
      all.back().places = distance_of_places(scene, strand, parameter);
    }
  }
  return all;
}

void check_starts(const Scene& scene, std::size_t strand, System& system,
                  std::span<const SceneParameter> parameters) {
  const SceneSupports supports(scene);
  if (!supports.hold(strand) || !supports.constrain()) return;
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
    refuse_gradient(
        parameter.name, "it takes the strand off its rigid supports at the start",
        supports.place(strand), "leave it out, or give [supports] stiffness_n_per_m");
  }
}

}  // namespace tress::simulation
