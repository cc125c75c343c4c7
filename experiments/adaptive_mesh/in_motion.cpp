#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "experiments/adaptive_mesh/adaptive_mesh.h"
#include "simulation/errors/error_bars.h"
#include "simulation/errors/pilot.h"
#include "simulation/run/tip_paths.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::adaptive_mesh {
namespace {

using simulation::Scene;

constexpr int fine = 96;  // elements, cut at rest too
constexpr int many_points = 32;

/// Let go from its natural shape under its weight; drag keeps neighbouring motions
/// together.
constexpr const char* let_go = R"(title = "let go"
duration_s = 0.5
frames_per_s = 32
[model]
id = "super_helix"
[integrator]
id = "backward_euler"
dt_s = 0.001
[material]
radius_m = 40e-6
youngs_modulus_pa = {}
ellipticity = 1
density_kg_m3 = 1300
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 2e-5
[strand]
length_m = {}
root_tangent = {}
{}
elements = {}
mesh = "rest"
tolerance_m = {}
)";

Scene scene_of(const LooseHair& hair, double tolerance) {
  return simulation::parse_scene(
      fmt::format(let_go, hair.young, hair.length, hair.tangent, hair.shape, fine,
                  tolerance * hair.length),
      hair.name + ".toml");
}

MotionError error_of(const Scene& own, const Scene& reference) {
  // These end with the reason where a run fails.
  const double tips = simulation::distance_rel(
      simulation::tip_paths(own, 0), simulation::tip_paths(reference, 0), reference);
  const simulation::StrandError points =
      simulation::distance(own, reference, 1, 1).strands.front();
  return {static_cast<int>(own.strands.front().segments.size()), tips,
          points.parts ? simulation::parted_from : points.error.largest};
}

}  // namespace

std::vector<LooseHair> loose_hairs() {
  std::vector<LooseHair> all;
  for (const double length : {0.05, 0.2}) {
    for (const double young : {1e8, 4e9}) {
      for (const char* tangent : {"[1, 0, 0]", "[1, 0, 1]", "[0.1, 0, -1]"}) {
        for (const char* shape :
             {"shape = \"straight\"",
              "shape = \"wavy\"\nwave_per_m = 30\nwavelength_m = 0.08",
              "shape = \"helix\"\ncurl_radius_m = 0.015\ncurl_pitch_m = 0.05"}) {
          all.push_back(
              {fmt::format("hair_{}", all.size()), length, young, tangent, shape});
        }
      }
    }
  }
  return all;
}

MotionError motion_error(const LooseHair& hair, double tolerance) {
  return error_of(scene_of(hair, tolerance), scene_of(hair, 0));
}

PilotError pilot_error(const LooseHair& hair, double tolerance) {
  const simulation::Pilot found = simulation::pilot(scene_of(hair, tolerance), 1);
  if (!found.missing.empty()) throw std::runtime_error(found.missing);
  const simulation::Pilot::OfStrand& one = found.strands.front();
  return {error_of(found.scene, scene_of(hair, 0)), one.error / hair.length,
          static_cast<double>(found.elements) / one.elements};
}

PointsError points_error(const Scene& given, int elements) {
  const Scene scene = simulation::with_elements(given, elements);
  Scene wide = scene;
  wide.model_options.set("quadrature", std::to_string(many_points));
  const auto tips = simulation::tip_paths(scene, 0);
  return {
      simulation::distance_rel(simulation::tip_paths(wide, 0), tips, scene),
      simulation::distance_rel(
          simulation::tip_paths(simulation::with_elements(given, fine), 0), tips, scene)};
}

}  // namespace tress::experiments::adaptive_mesh
