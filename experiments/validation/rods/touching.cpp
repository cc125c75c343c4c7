#include "experiments/validation/rods/touching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "experiments/problems/formulations.h"

namespace tress::experiments::validation {

simulation::Scene touching_strands(const ModelVariant& variant,
                                   std::vector<Strand> strands,
                                   const std::vector<EffectSettings>& effects, double dt,
                                   std::string_view integrator) {
  simulation::Scene scene;
  scene.name = "touching";
  scene.model = variant.model;
  scene.model_options =
      Parameters(variant.model->parameters, "model " + std::string(variant.model->id));
  for (const auto& [key, value] : variant.settings) scene.model_options.set(key, value);
  scene.integrator = integrator;
  const auto system = variant.model->on_strand(strands.front(), scene.model_options, {});
  const auto formulation =
      preferred_formulation(find_integrator(scene.integrator), *system);
  if (!formulation) {
    throw InputError("cannot drive this model", scene.integrator, "use another model");
  }
  scene.options.formulation = *formulation;
  scene.options.step = dt;
  scene.strands = std::move(strands);
  for (const EffectSettings& effect : effects) {
    const EffectEntry& entry = find_effect(effect.id, "test");
    Parameters parameters(entry.parameters, "effect " + std::string(effect.id));
    for (const auto& [key, value] : effect.settings) parameters.set(key, value);
    scene.effects.push_back({&entry, std::move(parameters)});
  }
  scene.duration = std::numeric_limits<double>::max();
  scene.guard = false;
  return scene;
}

void go_on(simulation::World& world, double t, const ContactRun& run) {
  const auto advance = [&](double to) {
    if (world.advance(to) != Status::ok) throw std::runtime_error(world.failure());
  };
  if (!run.each_drive) return advance(t);
  const double begin = world.time(), span = t - begin;
  const double steps = std::max(1.0, std::ceil(span / world.step() - 1e-9));
  for (double i = 1; i <= steps; ++i) {
    advance(i == steps ? t : begin + span * i / steps);
    run.each_drive(world.drive());
  }
}

Vec point(simulation::World& world, std::size_t strand, int i) {
  int first = 0;
  for (std::size_t k = 0; k < strand; ++k) first += world.points()[k];
  const int at = first + (i < 0 ? world.points()[strand] + i : i);
  return load3(&world.positions()[3 * static_cast<std::size_t>(at)]);
}

}  // namespace tress::experiments::validation
