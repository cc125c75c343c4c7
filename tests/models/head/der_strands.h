#pragma once

#include <cmath>

#include "contract/system.h"
#include "models/catalogue.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "models/strand/strand.h"
#include "simulation/head/make_head.h"

namespace tress::testing_support {

/// Discrete rods on a head, and what acts on them.
struct RodCase {
  std::string name;
  int elements = 10;
  bool moves = false;
  double curl = 1;     // scales the rest shapes
  bool sprung = true;  // released from another shape than that at rest
  double drag = 2e-5, mass_damping = 0.5;
  double friction = 2e-11;      // N m^2 s
  double youngs_modulus = 3e9;  // Pa
  double speed = 1;             // of the head's motion
  double twist = 0;             // of all shapes, 1/m
};
inline void PrintTo(const RodCase& c, std::ostream* out) { *out << c.name; }  // NOLINT

inline simulation::HeadOptions rod_options(const RodCase& c) {
  simulation::HeadOptions o{{.elements = c.elements,
                             .gravity = {0.5, 1, -9.81},
                             .drag = c.drag,
                             .mass_damping = c.mass_damping,
                             .longest = 0.25,
                             .motion = {}}};
  o.motion.position = {0.01, 0.02, 1.5};
  if (c.moves) {
    o.motion.translations = {{{0, 1, 0.5}, models::one_minus_cosine(0.01, 3 * c.speed)}};
    o.motion.rotations = {{{0, 0.6, 0.8}, models::one_minus_cosine(0.4, 2 * c.speed)}};
  }
  return o;
}

/// Strands that have nothing in common but their elements; their roots move as the head.
inline models::Strand rod(const RodCase& c, std::size_t k) {
  const double x = static_cast<double>(k % 11);
  models::Material material;
  material.density = 1300 + 10 * x;
  material.youngs_modulus = c.youngs_modulus / (1 + x / 4);
  material.shear_modulus =
      models::Material::shear_modulus_of(material.youngs_modulus, 0.4);
  material.internal_friction = c.friction * (1 + x);
  const Vec natural{4 - x / 3, 20 + 3 * std::sin(x), 5 * std::cos(x)};
  const Vec initial{x / 4, 12, -7};
  models::Strand made = models::make_strand(
      material, {4e-5 + 2e-6 * x, 5e-5},
      {.elements = c.elements, .length = 0.25 / (1 + x / 20), .grading = 1},
      models::uniform_shape(c.curl * natural + Vec{c.twist, 0, 0}),
      models::uniform_shape(c.curl * (c.sprung ? initial : natural) +
                            Vec{c.twist, 0, 0}));
  const simulation::HeadOptions o = rod_options(c);
  made.root = o.motion;
  made.root.centre = o.motion.position;
  made.root.position = o.motion.position + Vec{0.01 * x, 0.1 - 0.02 * x, 0.003};
  made.root.frame = rotation({0, 0.6, -0.8}, 0.3 * x);
  return made;
}

/// The same by itself.
inline std::unique_ptr<System> rod_alone(const RodCase& c, std::size_t k,
                                         const char* tangent) {
  const models::ModelEntry& entry = models::find_model("der");
  Parameters parameters(entry.parameters, "test");
  parameters.set("jacobian", tangent);
  const simulation::HeadOptions o = rod_options(c);
  return entry.on_strand(rod(c, k), parameters,
                         {std::make_shared<models::Gravity>(o.gravity),
                          std::make_shared<models::LinearDrag>(o.drag, o.mass_damping)});
}

/// Coordinates of a strand by itself as those of a head: edges (from x0 on) and angles.
inline std::vector<double> as_edges(In q, const Vec& x0) {
  const std::size_t n = q.size() / 4;
  std::vector<double> all(4 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec before = i == 0 ? x0 : load3(&q[3 * i - 3]);
    store3(load3(&q[3 * i]) - before, &all[4 * i]);
    all[4 * i + 3] = q[3 * n + i];
  }
  return all;
}

}  // namespace tress::testing_support
