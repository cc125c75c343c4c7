#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "models/motion/teleport.h"
#include "simulation/run/world.h"

namespace tress::test_teleport {

using namespace simulation;
using models::Displacement;

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double jump_at = 0.05, length = 0.1;  // s, m

inline const std::string hair = "[material]\nname = \"hair.asian\"\n";

/// `root`: keys of [root]; `rest`: further tables.
inline std::string text_of(const std::string& model, const std::string& integrator,
                           const std::string& root, const std::string& rest = "",
                           const std::string& material = hair) {
  const bool constrained = model == "inextensible_strand" || model == "dynamic_spline";
  return "title = \"teleport\"\nduration_s = 0.1\n[model]\nid = \"" + model +
         "\"\n[integrator]\n" + integrator +
         (constrained && integrator.find("formulation") == std::string::npos
              ? "\nformulation = \"projection\""
              : "") +
         "\n" + material + "[root]\n" + root +
         "[effects.gravity]\n[effects.linear_drag]\n" + rest;
}
inline Scene scene_of(const std::string& model, const std::string& integrator,
                      const std::string& root, const std::string& rest = "") {
  return parse_scene(text_of(model, integrator, root, rest), "teleport.toml");
}
inline const std::string strand =
    "[strand]\nlength_m = 0.1\nelements = 6\nposition_m = [0.02, 0.01, 0]\n"
    "shape = \"helix\"\n";
inline std::string steps(const std::string& id) {
  return "id = \"" + id + "\"\ndt_s = 1e-3";
}

/// Rows of a root that is at rest until it jumps to this row, and then stays there.
inline std::string to(const std::string& row) {
  return "motion = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], [0.05, 0, 0, 0, 0], "
         "[0.05, " +
         row + "]]\n";
}
/// A displacement that gravity does not see: a translation and a turn about its axis.
inline const std::string aside = to("0.3, -0.2, 0.1, 0.7"), nowhere = to("0, 0, 0, 0");

inline Displacement jump_of(const Scene& scene, double at = jump_at) {
  return models::displacement(scene.strands.front().root, models::teleport_time(at));
}

struct Points {
  std::vector<double> x, u;
};
inline Points points_of(World& world) { return {world.positions(), world.velocities()}; }

inline Points carried(const Displacement& by, Points points) {
  for (std::size_t i = 0; i < points.x.size(); i += 3) {
    const Vec x = load3(&points.x[i]);
    store3(by.velocity(x, load3(&points.u[i])), &points.u[i]);
    store3(by.place(x), &points.x[i]);
  }
  return points;
}

inline double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = a.size() == b.size() ? 0 : 1e300;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double now = std::abs(a[i] - b[i]);
    most = now <= most ? most : now;  // NaN is apart
  }
  return most;
}

inline std::vector<std::string> strand_models() {
  std::vector<std::string> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand != nullptr) all.emplace_back(model.id);
  }
  return all;
}

}  // namespace tress::test_teleport
