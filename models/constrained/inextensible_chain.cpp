#include "models/constrained/inextensible_chain.h"

#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "contract/system.h"
#include "models/constrained/joints.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_chain[] = {
    {.name = "links",
     .help = "number of links n",
     .number = 10,
     .min = 1,
     .max = 100'000,
     .whole = true},
    {.name = "closed", .help = "closed into a loop", .choices = "no|yes"},
    {.name = "mass_kg",
     .help = "mass of the strand (kg)",
     .number = 1,
     .min = 1e-12,
     .max = 1e6},
    {.name = "length_m",
     .help = "length of the strand (m)",
     .number = 1,
     .min = 1e-6,
     .max = 1e6},
    gravity_parameter,
    hanging_drag_parameter,
    hanging_spin_parameter,
};

ParticleScene open_chain(const ChainShape& shape, double mass, double link) {
  ParticleScene scene;
  Node previous = scene.add_anchor(Vec{});
  for (int i = 1; i <= shape.links; ++i) {
    const Node next = scene.add_particle(mass, {i * link, 0, 0}, {}, link);
    scene.constraints.push_back(distance(previous, next, link));
    previous = next;
  }
  return scene;
}

ParticleScene closed_chain(const ChainShape& shape, double mass, double link) {
  ParticleScene scene;
  const Node pivot = scene.add_anchor(Vec{});
  const double radius = link / (2 * std::sin(std::numbers::pi / shape.links));
  Node first, previous;
  for (int i = 0; i < shape.links; ++i) {
    const double w = 2 * std::numbers::pi * i / shape.links;
    const Node next = scene.add_particle(
        mass, {radius * (1 - std::cos(w)), 0, radius * std::sin(w)}, {}, link);
    if (i == 0) {
      scene.constraints.push_back(fixed_point(next, pivot));
      first = next;
    } else {
      scene.constraints.push_back(distance(previous, next, link));
    }
    previous = next;
  }
  scene.constraints.push_back(distance(previous, first, link));
  return scene;
}

}  // namespace

HangingShape hanging_shape(const Parameters& parameters) {
  return {.mass = parameters.number("mass_kg"),
          .length = parameters.number("length_m"),
          .gravity = parameters.number("gravity_m_s2"),
          .drag = parameters.number("drag_kg_m_s"),
          .spin = parameters.number("spin_rad_s")};
}

void add_gravity_and_drag(ParticleScene& scene, double gravity, double drag,
                          double height) {
  if (gravity != 0) {
    scene.effects.push_back(std::make_unique<Gravity>(Vec{0, 0, -gravity}));
    scene.typical_speed = std::sqrt(std::abs(gravity) * height);
  }
  if (drag != 0) scene.effects.push_back(std::make_unique<LinearDrag>(drag));
}

void spin_about_z(ParticleScene& scene, double spin) {
  for (auto& p : scene.particles) p.v = Vec{-spin * p.x.y, spin * p.x.x, 0};
}

ParticleScene inextensible_chain(const ChainShape& shape) {
  const int least = shape.closed ? 3 : 1;
  if (shape.links < least || !(shape.length > 0)) {
    throw InputError("too few links or no length", "inextensible chain",
                     "give at least 1 link (3 when closed) and a length > 0");
  }
  const double mass = shape.mass / shape.links;
  const double link = shape.length / shape.links;
  ParticleScene scene =
      shape.closed ? closed_chain(shape, mass, link) : open_chain(shape, mass, link);
  spin_about_z(scene, shape.spin);
  add_gravity_and_drag(scene, shape.gravity, shape.drag, shape.length);
  return scene;
}

std::span<const Parameter> inextensible_chain_parameters() { return parameters_of_chain; }

std::unique_ptr<System> make_inextensible_chain(const Parameters& parameters) {
  const ChainShape shape{hanging_shape(parameters), parameters.whole("links"),
                         parameters.word("closed") == "yes"};
  return std::make_unique<ParticleSystem>(inextensible_chain(shape));
}

}  // namespace tress::models
