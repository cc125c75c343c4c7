#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "experiments/statics/equilibrium_path.h"
#include "simulation/scene/scene.h"

/// Scenes of equilibria, and their paths.
namespace tress::testing_support {

/// EI of a strand of radius 50 um and 3 GPa, N m^2.
inline const double bending_of_strand = 3e9 * std::numbers::pi * std::pow(50e-6, 4) / 4;

/// A strand of this material; `strand` and `rest` are lines of the scene.
inline std::string static_scene(const std::string& model, const std::string& strand,
                                const std::string& rest) {
  return "title = \"statics\"\nduration_s = 1\n[model]\n" + model +
         "\n[integrator]\nid = \"bdf2\"\n[material]\nname = \"custom\"\nradius_m = "
         "50e-6\nyoungs_modulus_pa = 3e9\npoisson_ratio = 0.45\ndensity_kg_m3 = "
         "1300\n[strand]\n" +
         strand + "\n" + rest;
}

/// A column of 0.1 m, clamped below, under the force EI/L^2 downwards at its tip.
inline std::string column(const std::string& model, int elements,
                          const std::string& more = "") {
  return static_scene(
      model,
      "length_m = 0.1\nroot_tangent = [0, 0, 1]\nelements = " + std::to_string(elements),
      "[[effects.point_force]]\nforce_n = [0, 0, " +
          std::to_string(-1e9 * bending_of_strand / 0.01) + "e-9]\n" + more);
}

/// The strand of a scene's text, and what varies.
inline experiments::statics::StaticStrand static_strand(const std::string& text,
                                                        const std::string& over) {
  const simulation::Scene scene = simulation::parse_scene(text, "statics.toml");
  return {scene, 0, experiments::statics::varied(scene, over, "--over")};
}

/// Follows the path of a scene.
inline std::vector<experiments::statics::PathPoint> static_path(
    const std::string& text, const std::string& over,
    experiments::statics::PathOptions options = {}) {
  auto strand = static_strand(text, over);
  return experiments::statics::equilibrium_path(strand, options);
}

/// Values of the parameter at the events of a kind.
inline std::vector<double> values_at(
    const std::vector<experiments::statics::PathPoint>& path,
    experiments::statics::Event event) {
  std::vector<double> all;
  for (const auto& point : path) {
    if (point.event == event) all.push_back(point.at.value);
  }
  return all;
}

/// Tip of a point of a path, m.
inline Vec tip_of(const experiments::statics::PathPoint& point) {
  return load3(&point.x[point.x.size() - 3]);
}

}  // namespace tress::testing_support
