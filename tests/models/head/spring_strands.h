#pragma once

#include "contract/forms/material_points.h"
#include "integrators/catalogue.h"
#include "models/effects/body.h"
#include "tests/models/head/der_strands.h"
#include "tests/models/head/exact_methods.h"
#include "tests/support/apart.h"

namespace tress::testing_support {

/// A head of springs whose strands are those of discrete rods.
inline std::unique_ptr<models::Head> springs(const RodCase& c, const HairMethod& method,
                                             const models::HeadPack& pack,
                                             std::size_t strands,
                                             const models::Effects& effects = {}) {
  simulation::HeadOptions options = rod_options(c);
  options.method = method.method;
  options.effects = effects;
  auto all = simulation::spring_head(options, pack);
  for (std::size_t k = 0; k < strands; ++k) all->add(rod(c, k));
  return all;
}

/// So many steps of so many blocks in a call.
inline void advance_springs(models::Head& all, int steps, double h,
                            std::size_t together = 100) {
  const auto scratch = all.scratch();
  for (int s = 0; s < steps; ++s) {
    for (std::size_t b = 0; b < all.blocks(); b += together) {
      all.step(b, std::min(all.blocks(), b + together), s * h, h, *scratch);
    }
  }
}

/// A strand by itself, with the tangent of the method's heads.
inline std::unique_ptr<System> spring_alone(const models::Strand& strand,
                                            const simulation::HeadOptions& o,
                                            const HairMethod& method,
                                            const models::Effects& more = {}) {
  const models::ModelEntry& entry = models::find_model("mass_spring");
  Parameters parameters(entry.parameters, "test");
  parameters.set("jacobian", method.left > 0 ? "exact" : "filtered");
  models::Effects effects = {
      std::make_shared<models::Gravity>(o.gravity),
      std::make_shared<models::LinearDrag>(o.drag, o.mass_damping)};
  effects.insert(effects.end(), more.begin(), more.end());
  return entry.on_strand(strand, parameters, effects);
}

/// Its integrator, with a new matrix in every iteration, as heads have it.
inline std::unique_ptr<Integrator> spring_method(const HairMethod& method, System& system,
                                                 double h) {
  Options options;
  options.step = h;
  options.refresh = Refresh::every_iteration;
  return integrators::make_integrator(method.id, system, options);
}

/// Nodes as edges, from x0 on; rates and corrections from 0.
inline std::vector<double> spring_edges(In q, const Vec& x0) {
  std::vector<double> all(q.size());
  for (std::size_t i = 0; i < q.size(); i += 3) {
    store3(load3(&q[i]) - (i == 0 ? x0 : load3(&q[i - 3])), &all[i]);
  }
  return all;
}

/// A strand by itself after the same steps, from a start that differs by `change`.
struct SpringAlone {
  std::vector<double> q, v, x;
};
inline SpringAlone spring_alone(const RodCase& c, const HairMethod& method, std::size_t k,
                                int steps, double h, double change,
                                const models::Effects& more = {}) {
  const auto system = spring_alone(rod(c, k), rod_options(c), method, more);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n);
  system->initial_state(q, v);
  const Vec root = rod(c, k).root.at(0).x;
  for (std::size_t i = 0; i < n; ++i) {
    q[i] += (i % 2 == 0 ? change : -change) * (q[i] - (&root.x)[i % 3]);
  }
  const auto of = spring_method(method, *system, h);
  EXPECT_EQ(of->start(0, q, v), Status::ok);
  EXPECT_EQ(of->advance(steps * h), Status::ok) << of->failure();
  SpringAlone end;
  end.x.resize(n + 3);
  system->material_points()->positions(steps * h, of->q(), end.x);
  end.q = spring_edges(of->q(), load3(end.x.data()));
  end.v = spring_edges(of->v(), {});
  return end;
}

/// Points of all strands, and their velocities.
inline std::vector<double> spring_points(const models::Head& all, double t,
                                         std::vector<double>& v) {
  std::vector<double> x(all.strands() * all.numbers());
  v.resize(x.size());
  std::size_t done = 0;
  for (std::size_t b = 0; b < all.blocks(); ++b) {
    const std::size_t size = all.strands_of(b) * all.numbers();
    all.motion(b, t, std::span(x).subspan(done, size), std::span(v).subspan(done, size));
    done += size;
  }
  return x;
}

/// So soft that strands which overlap it at first move by centimetres; friction and
/// damping of the order of the spring's force.
inline constexpr models::BodyContact soft_contact{
    .stiffness = 0.05, .damping = 0.5, .friction = 0.4, .slip = 0.02, .offset = 1e-3};

struct SpringBodies {
  std::string name;
  std::vector<models::BodyShape> shapes;
  bool moves = false;
  int elements = 10;
};
inline void PrintTo(const SpringBodies& b, std::ostream* out) {  // NOLINT
  *out << b.name;
}

inline models::Effects effects_of(const SpringBodies& b, const RodCase& c) {
  std::optional<models::RootMotion> follows;
  if (b.moves) follows = rod_options(c).motion;
  models::Effects all;
  for (const models::BodyShape& shape : b.shapes) {
    all.push_back(std::make_shared<models::Body>(
        shape, models::StrandPlace{{0.12, 0.08, 1.43}, rotation({0.6, 0, 0.8}, 0.7)},
        soft_contact, follows));
  }
  return all;
}
inline RodCase case_of(const SpringBodies& b) {
  return {.name = "", .elements = b.elements, .moves = b.moves, .youngs_modulus = 1e8};
}

inline const SpringBodies spring_bodies[] = {
    {"APlane", {models::Plane{}}},
    {"ASphere", {models::Sphere{0.1}}},
    {"AnEllipsoid", {models::Ellipsoid({0.08, 0.1, 0.12})}},
    {"AMovingEllipsoid", {models::Ellipsoid({0.08, 0.1, 0.12})}, true},
    {"ACapsuleAndASphere", {models::Capsule{0.06, 0.1}, models::Sphere{0.1}}}};

inline const RodCase spring_cases[] = {
    {"Curly"},
    {.name = "Moved", .moves = true},
    {.name = "Straight", .curl = 0},
    {.name = "OneEdge", .elements = 1, .curl = 0.3},
    {.name = "TwoEdges", .elements = 2, .moves = true},
    {.name = "Fine", .elements = 40, .moves = true},
    {.name = "Tight", .curl = 4},
    {.name = "InVacuum", .drag = 0, .mass_damping = 0},
    {.name = "WithoutFriction", .friction = 0},
    {.name = "Soft", .moves = true, .youngs_modulus = 1e8}};

}  // namespace tress::testing_support
