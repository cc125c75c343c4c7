#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "experiments/problems/strand_models.h"
#include "experiments/validation/rods/contact_run.h"
#include "models/strand/strand.h"
#include "simulation/run/world.h"

namespace tress::experiments::validation {

/// An effect of a scene with what differs from its defaults.
struct EffectSettings {
  std::string_view id;
  std::vector<std::pair<std::string_view, std::string>> settings;
};

/// Strands of that model that touch each other, and the step dt (s) of their method.
simulation::Scene touching_strands(const ModelVariant& variant,
                                   std::vector<Strand> strands,
                                   const std::vector<EffectSettings>& effects, double dt,
                                   std::string_view integrator = "backward_euler");

/// Advances to t, one step at a time where `run` receives the drive. Throws
/// std::runtime_error if the world does not get there.
void go_on(simulation::World& world, double t, const ContactRun& run = {});

/// A material point of a strand, from its tip: -1, -2, ...
Vec point(simulation::World& world, std::size_t strand, int i);

}  // namespace tress::experiments::validation
