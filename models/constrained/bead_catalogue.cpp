#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/system.h"
#include "models/constrained/bead_on_wire.h"
#include "models/constrained/inextensible_chain.h"
#include "models/constrained/on_curve.h"
#include "models/effects/gravity.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_bead[] = {
    {.name = "curve",
     .help = "shape of the wire",
     .choices = "circle|ellipse|helix|trefoil"},
    {.name = "form",
     .help = "coordinates x with lambda, or s",
     .choices = "implicit|parametric"},
    {.name = "jacobian",
     .help = "Jacobian of the parametric form",
     .choices = "exact|elastic"},
    {.name = "mass_kg",
     .help = "mass of the bead (kg)",
     .number = 1,
     .min = 1e-12,
     .max = 1e6},
    {.name = "radius_m",
     .help = "radius, or semi-axis along x (m)",
     .number = 1,
     .min = 1e-6,
     .max = 1e6},
    {.name = "height_m",
     .help = "semi-axis of the ellipse along z (m)",
     .number = 0.5,
     .min = 1e-6,
     .max = 1e6},
    {.name = "pitch_m",
     .help = "rise of the helix per turn (m)",
     .number = 0.5,
     .min = 1e-6,
     .max = 1e6},
    gravity_parameter,
    {.name = "drag_kg_s",
     .help = "linear drag of the bead (kg/s)",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "start_rad",
     .help = "curve parameter at t = 0 (rad)",
     .number = 0,
     .min = -1e3,
     .max = 1e3},
    {.name = "speed_m_s",
     .help = "initial speed along the wire (m/s)",
     .number = 0,
     .min = -1e6,
     .max = 1e6},
};

/// The wire itself, as the parametric form sees it.
struct Wire {
  std::shared_ptr<const Curve> curve;
  bool uniform;
  double extent;  // m
};

struct Axes {
  Vec a, b, rise;
};

Axes axes_of(const Parameters& p) {
  const double r = p.number("radius_m");
  const std::string_view curve = p.word("curve");
  if (curve == "helix") {
    return {{r, 0, 0}, {0, r, 0}, {0, 0, p.number("pitch_m") / (2 * std::numbers::pi)}};
  }
  return {{r, 0, 0}, {0, 0, curve == "ellipse" ? p.number("height_m") : r}, {}};
}

Wire wire_of(const Parameters& p) {
  const double r = p.number("radius_m");
  if (p.word("curve") == "trefoil") return {trefoil(r), false, r};
  const Axes axes = axes_of(p);
  return {helix_curve({}, axes.a, axes.b, axes.rise), p.word("curve") != "ellipse", r};
}

ParticleScene implicit_scene(const Parameters& p, const Wire& wire) {
  ParticleScene scene;
  const double start = p.number("start_rad");
  const CurvePoint at = wire.curve->at(start);
  const double rate = p.number("speed_m_s") / std::sqrt(dot(at.d1, at.d1));
  const Node bead = scene.add_particle(p.number("mass_kg"), at.c, rate * at.d1, 1);
  const Axes axes = axes_of(p);
  if (p.word("curve") == "trefoil") {
    const Node s = scene.add_parameter(start, rate);
    scene.constraints.push_back(point_on_curve(bead, s, wire.curve));
  } else if (p.word("curve") == "helix") {
    scene.constraints.push_back(
        point_on_helix(bead, scene.add_anchor(Vec{}), axes.a, axes.b, axes.rise));
  } else {
    scene.constraints.push_back(
        point_on_ellipse(bead, scene.add_anchor(Vec{}), axes.a, axes.b));
  }
  return scene;
}

}  // namespace

std::span<const Parameter> bead_on_wire_parameters() { return parameters_of_bead; }

std::unique_ptr<System> make_bead_on_wire(const Parameters& parameters) {
  const Wire wire = wire_of(parameters);
  ParticleScene scene = implicit_scene(parameters, wire);
  // a bead counts as 1 m of strand, so that drag in kg/(m s) is drag in kg/s
  add_gravity_and_drag(scene, parameters.number("gravity_m_s2"),
                       parameters.number("drag_kg_s"), wire.extent);
  if (parameters.word("form") == "implicit") {
    return std::make_unique<ParticleSystem>(std::move(scene));
  }
  BeadOnWire::Setup setup;
  setup.curve = wire.curve;
  setup.mass = parameters.number("mass_kg");
  setup.start = parameters.number("start_rad");
  setup.start_speed = parameters.number("speed_m_s");
  setup.extent = wire.extent;
  setup.typical_speed = std::max(scene.typical_speed, std::abs(setup.start_speed));
  if (setup.typical_speed == 0) setup.typical_speed = wire.extent;  // per second
  setup.uniform = wire.uniform;
  if (parameters.word("jacobian") == "elastic") setup.jacobian = Jacobian::elastic;
  return std::make_unique<BeadOnWire>(std::move(setup), std::move(scene.effects));
}

}  // namespace tress::models
