#include "experiments/validation/rods/turned_rod.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace tress::experiments::validation {
namespace {

constexpr double youngs_modulus = 1e6;  // Pa
constexpr const char* name = "turned_rod.toml";

}  // namespace

double TurnedRod::bending() {
  return youngs_modulus * std::numbers::pi * std::pow(radius, 4) / 4;
}

double TurnedRod::separation() { return 0.06 * length; }

simulation::Scene TurnedRod::scene(const ModelVariant& variant, int elements) const {
  std::string text = fmt::format(
      "title = \"turned rod\"\nduration_s = {}\nguard = false\n[model]\nid = \"{}\"\n",
      pushes.back().time, variant.model->id);
  for (const auto& [key, value] : variant.settings) {
    text += fmt::format("{} = \"{}\"\n", key, value);
  }
  text += fmt::format(
      "[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = {}\n"
      "[material]\nname = \"custom\"\nradius_m = {}\nyoungs_modulus_pa = {}\n"
      "poisson_ratio = {}\ndensity_kg_m3 = {}\ninternal_friction_kg_m3_s = {}\n"
      "[strand]\nelements = {}\npoints = [",
      step, radius, youngs_modulus, 1 / twist_over_bend - 1, density, internal_friction,
      elements);
  constexpr int points = 5;
  for (int i = 0; i <= points; ++i) {
    text += fmt::format("[{}, 0, 0],", length * i / points);
  }
  text += "]\n[[supports]]\nat = \"tip\"\nkind = \"clamp\"\nkeyframes = [";
  for (const Push& push : pushes) {
    text += fmt::format("[{}, {}, 0, 0],", push.time, length * (1 - push.shortening));
  }
  text += fmt::format("]\ntwist_rad = [[0, 0], [{}, {}]]\n", turning,
                      2 * std::numbers::pi * turns);
  text += fmt::format("[effects.linear_drag]\ndrag_kg_m_s = {}\n", drag);
  if (contact_radius > 0) {
    text += fmt::format(
        "[effects.self_contact]\nstiffness_n_m2 = 200\nviscosity_n_s_m2 = 1e-3\n"
        "inner_radius_m = {}\nouter_radius_m = {}\nseparation_m = {}\n",
        2 * contact_radius, 2.5 * contact_radius, separation());
  }
  return simulation::parse_scene(text, name);
}

TipLoad tip_load(simulation::World& world) {
  constexpr double length = TurnedRod::length;
  const double bending = TurnedRod::bending();
  const simulation::World::SupportLoads loads = world.support_loads();
  return {loads.forces.at(0) * length * length / bending,
          loads.moments.at(0) * length / bending};
}

double largest_tilt(simulation::World& world) {
  const std::vector<double>& x = world.positions();
  double least = 1;
  for (std::size_t i = 3; i < x.size(); i += 3) {
    const Vec chord = load3(&x[i]) - load3(&x[i - 3]);
    least = std::min(least, chord.x / norm(chord));
  }
  return std::acos(std::max(least, -1.0));
}

}  // namespace tress::experiments::validation
