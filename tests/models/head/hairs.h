#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

#include "contract/forms/material_points.h"
#include "integrators/catalogue.h"
#include "models/clothoid/super_clothoid.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/super_helix.h"
#include "simulation/head/make_head.h"
#include "tests/models/head/arrangements.h"
#include "tests/models/head/exact_methods.h"

namespace tress::testing_support {

using namespace simulation;
using integrators::make_integrator;

/// What hair is made of, as a head and by itself.
struct HairModel {
  std::string_view name;
  std::unique_ptr<Head> (*head)(const HeadOptions&, const HeadPack&);
  std::unique_ptr<System> (*alone)(const Strand&, const ReducedOptions&, Effects);
  /// Relative change of a start that makes no less than the roundings of all steps do.
  double rounding;
  std::size_t per_element = 3;  // coordinates of an element
};
inline constexpr HairModel helices{"Helices", helix_head, super_helix, 1e-12},
    chains{"Chains", chain_head, articulated_chain, 3e-11},
    clothoids{"Clothoids", clothoid_head, super_clothoid, 4e-12, 6};
inline constexpr const HairModel* hair_models[] = {&helices, &chains, &clothoids};

inline constexpr double hair_step = 1e-4;  // s

struct Case {
  std::string name;
  int elements = 10, points = 8;
  bool twist = true, moves = false;
  double curl = 1;     // scales the rest shapes
  double uneven = 1;   // and once more those of every third strand
  bool sprung = true;  // released from another shape than that at rest
  double drag = 2e-5, mass_damping = 0.5;
  Effects effects = {};                                 // on all strands
  std::function<Effects(std::size_t strand)> own = {};  // of each strand
  const HairMethod* method = &one_solve;
  double step = hair_step;  // s
  int steps = 100;          // of a run that is compared
  const HairModel* model = &helices;
  /// Returns the number of coordinates of a strand.
  std::size_t coordinates() const {
    return model->per_element * static_cast<std::size_t>(elements);
  }
  Effects own_of(std::size_t k) const { return own ? own(k) : Effects{}; }
};
inline void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }  // NOLINT

/// The same with the exact Jacobian, whose steps are longer, of hairs that are let go in
/// their rest shape: sprung ones whirl so fast that such steps have no solution, or turn
/// back.
inline Case exact(Case c, const HairMethod& method) {
  c.name += method.name;
  c.method = &method;
  c.sprung = false;
  c.step = 1e-3;
  return c;
}

inline HeadOptions options(const Case& c) {
  HeadOptions o{{.elements = c.elements,
                 .points = c.points,
                 .twist = c.twist,
                 .gravity = {0.5, 1, -9.81},
                 .drag = c.drag,
                 .mass_damping = c.mass_damping,
                 .longest = 0.25,
                 .motion = {},
                 .effects = c.effects}};
  o.method = c.method->method;
  o.motion.position = {0.01, 0.02, 1.5};
  if (c.moves) {
    o.motion.translations = {{{0, 1, 0.5}, one_minus_cosine(0.01, 3)}};
    o.motion.rotations = {{{0, 0.6, 0.8}, one_minus_cosine(0.4, 2)}};
  }
  return o;
}

/// Strands that have nothing in common but their elements; their roots move as the head.
inline Strand strand(const Case& c, std::size_t k) {
  const double x = static_cast<double>(k % 11);
  Material material;
  material.density = 1300 + 10 * x;
  material.youngs_modulus = 3e9 / (1 + x / 4);
  material.internal_friction = 2e-11 * (1 + x);
  const Vec natural{c.twist ? 4 - x / 3 : 0, 20 + 3 * std::sin(x), 5 * std::cos(x)};
  const Vec initial{c.twist ? x / 4 : 0, 12, -7};
  const double curl = c.curl * (k % 3 == 1 ? c.uneven : 1);
  Strand made =
      make_strand(material, {4e-5 + 2e-6 * x, 5e-5},
                  {.elements = c.elements, .length = 0.25 / (1 + x / 20), .grading = 1},
                  uniform_shape(curl * natural),
                  uniform_shape(curl * (c.sprung ? initial : natural)));
  // Of each element the strain grows or falls by a tenth on either side of its mean.
  for (std::size_t i = 0; i < made.segments.size(); ++i) {
    Segment& s = made.segments[i];
    s.natural_half = (i % 2 == 0 ? 0.1 : -0.1) * s.natural;
    s.initial_half = (i % 2 == 0 ? 0.1 : -0.1) * s.initial;
  }
  const HeadOptions o = options(c);
  made.root = o.motion;
  made.root.centre = o.motion.position;
  made.root.position = o.motion.position + Vec{0.01 * x, 0.1 - 0.02 * x, 0.003};
  made.root.frame = rotation({0, 0.6, -0.8}, 0.3 * x);
  return made;
}

/// Numbers that its head can have: rigid links by single corrections have 64 bits.
inline std::vector<HeadPack> packs_of(const Case& c) {
  return packs_of_build(c.model != &chains || c.method != &midpoint);
}

inline std::unique_ptr<Head> head(const Case& c, HeadPack pack, std::size_t strands) {
  auto all = c.model->head(options(c), pack);
  for (std::size_t k = 0; k < strands; ++k) all->add(strand(c, k), c.own_of(k));
  return all;
}

inline void advance(Head& all, int steps, double dt = hair_step) {
  const auto scratch = all.scratch();
  for (int s = 0; s < steps; ++s) {
    for (std::size_t b = 0; b < all.blocks(); ++b) all.step(b, s * dt, dt, *scratch);
  }
}

/// The same strand by itself: coordinates in the head's order, and points.
struct Alone {
  std::vector<double> q, v, x, u;  // u: velocities of points
  double size = 0, rate = 0;       // System::scale of q and v
};
/// What Newton's method may leave in a step, over System::scale.
inline double left_by_newton(const Case& c) {
  return c.method->left * Options{}.newton_tolerance;
}
/// A relative change of the start that makes no less than so many steps' errors do.
inline double change_of_start(const Case& c, int steps) {
  return c.model->rounding + c.method->left_after(steps);
}
/// After these times (s) one after the other, in steps of `step` at most.
inline Alone alone(const Case& c, std::size_t k, std::span<const double> times,
                   double step, double change) {
  const Strand one = strand(c, k);
  const ReducedOptions of_model{.dofs = c.twist ? 3 : 2,
                                .jacobian = c.method == &one_solve
                                                ? ReducedJacobian::elastic
                                                : ReducedJacobian::exact,
                                .quadrature = c.points};
  const HeadOptions o = options(c);
  Effects effects = {std::make_shared<Gravity>(o.gravity),
                     std::make_shared<LinearDrag>(o.drag, o.mass_damping)};
  effects.insert(effects.end(), c.effects.begin(), c.effects.end());
  const Effects own = c.own_of(k);
  effects.insert(effects.end(), own.begin(), own.end());
  const auto system = c.model->alone(one, of_model, effects);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n), size(n), of_rate(n);
  system->initial_state(q, v);
  system->scale(size, of_rate);
  for (std::size_t i = 0; i < n; ++i) {
    q[i] += (i % 2 == 0 ? change : -change) * (std::abs(q[i]) + size[i]);
  }
  Options in_steps;
  in_steps.step = step;
  const auto method_of = make_integrator(c.method->id, *system, in_steps);
  EXPECT_EQ(method_of->start(0, q, v), Status::ok);
  double t = 0;
  for (const double time : times) {
    EXPECT_EQ(method_of->advance(t += time), Status::ok) << method_of->failure();
  }
  Alone end;
  end.size = size[0];
  end.rate = of_rate[0];
  end.x.resize(3 * static_cast<std::size_t>(c.elements + 1));
  end.u.resize(end.x.size());
  system->material_points()->positions(t, method_of->q(), end.x);
  system->material_points()->velocities(t, method_of->q(), method_of->v(), end.u);
  const auto put = [&](In from, std::vector<double>& to) {
    for (std::size_t i = 0; i < c.coordinates() / 3; ++i) {
      if (c.twist) {
        to.insert(to.end(), {from[3 * i], from[3 * i + 1], from[3 * i + 2]});
      } else {
        to.insert(to.end(), {0.0, from[2 * i], from[2 * i + 1]});
      }
    }
  };
  put(method_of->q(), end.q);
  put(method_of->v(), end.v);
  return end;
}
inline Alone alone(const Case& c, std::size_t k, int steps, double change) {
  return alone(c, k, std::array{steps * c.step}, c.step, change);
}

}  // namespace tress::testing_support
