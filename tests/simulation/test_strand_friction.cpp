// Exact contact between strands: nothing passes through, momentum is kept, and friction
// is Coulomb's; for every strand model and both methods.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "contract/input_error.h"
#include "math/closest.h"
#include "models/catalogue.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"

namespace tress::test_strand_friction {

using namespace simulation;

struct Set {
  std::string model = "der";
  std::string options = {};
  std::string integrator = "backward_euler";
  std::string strands = {};
  std::string effects = "[effects.gravity]\n";
  std::string friction = "thickness_m = 1e-3\n";
  std::string root = "fixed";
  std::string material = "ellipticity = 1\n";
  double step = 2e-3;
};

std::string formulation_of(const std::string& model) {
  const bool constrained = model == "inextensible_strand" || model == "dynamic_spline";
  return constrained ? "formulation = \"index3\"\n" : "";
}

Scene scene(const Set& set) {
  const bool none = set.friction == "none";
  return parse_scene(
      fmt::format("title = \"t\"\nduration_s = 1\nguard = false\n[model]\nid = \"{}\"\n{}"
                  "[integrator]\nid = \"{}\"\ndt_s = {}\n{}[material]\n"
                  "name = \"hair.asian\"\n{}{}[root]\nmotion = \"{}\"\n{}{}",
                  set.model, set.options, set.integrator, set.step,
                  formulation_of(set.model), set.material, set.strands, set.root,
                  set.effects, none ? "" : "[effects.strand_friction]\n" + set.friction),
      "t.toml");
}

/// A hair along x, and one across it that hangs from a root beside it and falls onto it.
std::string crossing(const std::string& more = {}) {
  return "[[strand]]\nlength_m = 0.06\nelements = 6\nroot_tangent = [1, 0, 0]\n" + more +
         "[[strand]]\nlength_m = 0.06\nelements = 6\nposition_m = [0.02, -0.03, 0.003]\n"
         "root_tangent = [0, 1, 0]\nnormal = [1, 0, 0]\n" +
         more;
}

/// Two more: one falls onto the first as well, the other lies below.
std::string four() {
  return crossing() +
         "[[strand]]\nlength_m = 0.06\nelements = 6\nposition_m = [0.03, -0.03, 0.006]\n"
         "root_tangent = [0, 1, 0]\nnormal = [1, 0, 0]\n"
         "[[strand]]\nlength_m = 0.06\nelements = 6\nposition_m = [0, 0, -0.01]\n"
         "root_tangent = [1, 0, 0]\n";
}

constexpr const char* one_system = "jacobian = \"elastic\"\nsolver = \"recursive\"\n";

constexpr double earth = 9.81;  // m/s^2

Vec point(World& world, std::size_t i) { return load3(&world.positions()[3 * i]); }

/// Least distance of the axes of two strands, or of parts of one that are more than
/// `apart` segments from each other.
double distance(World& world, std::size_t first, std::size_t second,
                std::size_t apart = 0) {
  std::vector<std::size_t> from{0};
  for (const int points : world.points()) {
    from.push_back(from.back() + static_cast<std::size_t>(points));
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = from[first]; i + 1 < from[first + 1]; ++i) {
    for (std::size_t j = from[second]; j + 1 < from[second + 1]; ++j) {
      if (first == second && j <= i + apart) continue;
      const StraightPiece a(point(world, i), point(world, i + 1)),
          b(point(world, j), point(world, j + 1));
      const NearestPoints near = nearest(a, b);
      least = std::min(least, norm(a.at(near.of_first) - b.at(near.of_second)));
    }
  }
  return least;
}

struct Case {
  std::string model, integrator;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    for (const char* const method : {"backward_euler", "linearly_implicit_euler"}) {
      all.push_back({std::string(model.id), method});
    }
  }
  return all;
}

class StrandFriction : public testing::TestWithParam<Case> {};

TEST_P(StrandFriction, NothingFallsThroughAnother) {
  Set set{.model = GetParam().model,
          .integrator = GetParam().integrator,
          .strands = crossing()};
  // Where a soft strand is not stable at 2 ms without contact, with shorter steps.
  if (set.integrator == "linearly_implicit_euler") set.step = 5e-4;
  World world(scene(set));
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= 60; ++i) {
    ASSERT_EQ(world.advance(5e-3 * i), Status::ok) << world.failure();
    least = std::min(least, distance(world, 0, 1));
  }
  EXPECT_GT(least, 0.94e-3);
  EXPECT_LT(least, 1.01e-3);
  EXPECT_GT(world.friction()->contacts(), 0u);
  const Stats stats = world.stats();
  EXPECT_EQ(stats.contact_unfinished, 0);
  EXPECT_GT(stats.contact_iterations, 0);

  // Alone it falls through.
  set.friction = "none";
  World alone(scene(set));
  double nearest_alone = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= 60; ++i) {
    ASSERT_EQ(alone.advance(5e-3 * i), Status::ok) << alone.failure();
    nearest_alone = std::min(nearest_alone, distance(alone, 0, 1));
  }
  EXPECT_LT(nearest_alone, 0.5e-3);
}

INSTANTIATE_TEST_SUITE_P(Models, StrandFriction, testing::ValuesIn(cases()),
                         [](const auto& tested) {
                           return tested.param.model + "_" + tested.param.integrator;
                         });

/// Clamped above a ball, onto which it falls: no point enters it, and friction lets it
/// come to rest on it.
TEST_P(StrandFriction, NoPointEntersABody) {
  Set set{.model = GetParam().model,
          .integrator = GetParam().integrator,
          .strands =
              "[strand]\nlength_m = 0.06\nelements = 12\n"
              "root_tangent = [1, 0, 0]\n",
          .effects =
              "[effects.gravity]\n[effects.linear_drag]\nmass_damping_per_s = 10\n"
              "[effects.body]\nshape = \"sphere\"\nradius_m = 0.01\n"
              "centre_m = [0.03, 0.001, -0.015]\nstrand_radius_m = 1e-3\n"
              "friction_law = \"exact\"\nnormal = \"rigid\"\n",
          .friction = "own = \"no\"\n"};
  if (set.integrator == "linearly_implicit_euler") set.step = 5e-4;
  World world(scene(set));
  double deepest = 0;
  for (int i = 1; i <= 60; ++i) {
    ASSERT_EQ(world.advance(5e-3 * i), Status::ok) << world.failure();
    for (std::size_t k = 0; k < 13; ++k) {
      const Vec from_centre = point(world, k) - Vec{0.03, 0.001, -0.015};
      deepest = std::max(deepest, 0.011 - norm(from_centre));
    }
  }
  EXPECT_GT(world.stats().contact_iterations, 0);
  EXPECT_EQ(world.stats().contact_unfinished, 0);
  // A point that slides by d leaves the tangent plane by d^2/(2 R), 2 um for 0.2 mm.
  EXPECT_LT(deepest, 1e-5);
}

/// A wire that crosses pieces far from their ends holds a strand, too.
TEST(StrandFriction, NoWireSlipsBetweenPoints) {
  for (const char* const model : {"super_helix", "der"}) {
    Set set{.model = model,
            .strands =
                "[strand]\nlength_m = 0.06\nelements = 4\n"
                "root_tangent = [1, 0, 0]\n",
            .effects =
                "[effects.gravity]\n[effects.body]\nshape = \"capsule\"\n"
                "radius_m = 5e-4\nlength_m = 0.04\nstrand_radius_m = 1e-3\n"
                "centre_m = [0.0375, 0, -0.004]\nrotation_rad = [1.5707963, 0, 0]\n"
                "friction_law = \"exact\"\nnormal = \"rigid\"\n",
            .friction = "own = \"no\"\n"};
    World world(scene(set));
    const StraightPiece wire({0.0375, -0.02, -0.004}, {0.0375, 0.02, -0.004});
    double least = 1;
    for (int i = 1; i <= 60; ++i) {
      ASSERT_EQ(world.advance(5e-3 * i), Status::ok) << world.failure();
      for (std::size_t k = 0; k < 4; ++k) {
        const StraightPiece piece(point(world, k), point(world, k + 1));
        const NearestPoints near = nearest(piece, wire);
        least = std::min(least, norm(piece.at(near.of_first) - wire.at(near.of_second)));
      }
    }
    // Pieces are looked at every 1.5 mm, between which they may come nearer by 0.2 mm.
    EXPECT_GT(least, 1.25e-3) << model;
    EXPECT_LT(least, 1.55e-3) << model;
  }
}

/// By one linear solve a step: what Coulomb's law says of n steps of backward Euler.
TEST(StrandFriction, OnASlopeSticksOrSlidesByHand) {
  for (const char* const model : {"super_helix", "der", "corde", "mass_spring"}) {
    for (const double tangent : {0.29, 0.29997, 0.30003, 0.35}) {
      const double angle = std::atan(tangent), mu = 0.3;
      const double down = earth * std::sin(angle), onto = earth * std::cos(angle);
      Set set{.model = model,
              .integrator = "linearly_implicit_euler",
              .strands =
                  "[strand]\nlength_m = 0.1\nelements = 6\n"
                  "root_tangent = [0, 1, 0]\nnormal = [1, 0, 0]\n"
                  "position_m = [0, 0, 1e-3]\n",
              .effects = fmt::format("[effects.gravity]\ngravity_m_s2 = [{}, 0, {}]\n"
                                     "[effects.body]\nfriction_law = \"exact\"\n"
                                     "normal = \"rigid\"\nstrand_radius_m = 1e-3\n",
                                     down, -onto),
              .friction = "tolerance_m_s = 1e-12\nsweeps = 10000\n",
              .root = "free",
              .material = "ellipticity = 1\nradius_m = 1e-3\n",
              .step = 1e-3};
      World world(scene(set));
      constexpr int steps = 500;
      ASSERT_EQ(world.advance(set.step * steps), Status::ok) << world.failure();
      const double slides =
          std::max(0.0, down - mu * onto) * set.step * set.step * steps * (steps + 1) / 2;
      EXPECT_NEAR(point(world, 3).x, slides, 1e-9 * (1e-3 + slides)) << model << tangent;
      EXPECT_NEAR(point(world, 3).z, 1e-3, 1e-12);
    }
  }
}

/// It turns with a plate on which it lies, without creeping.
TEST(StrandFriction, SticksToABodyThatTurns) {
  Set set{.strands =
              "[strand]\nlength_m = 0.05\nelements = 6\n"
              "root_tangent = [0, 1, 0]\nnormal = [1, 0, 0]\n"
              "position_m = [0.01, 0, 1e-3]\n",
          .effects =
              "[effects.gravity]\n[effects.body]\nfriction_law = \"exact\"\n"
              "normal = \"rigid\"\nstrand_radius_m = 1e-3\nmoves = \"head\"\n"
              "friction = 0.9\n",
          .friction = "tolerance_m_s = 1e-12\nsweeps = 10000\n",
          .root = "free",
          .material = "ellipticity = 1\nradius_m = 1e-3\n"};
  Scene made = scene(set);
  const double rate = 2;  // rad/s, half a g at 10 cm would take 7
  made.head.rotations.push_back({{0, 0, 1}, [rate](double t) {
                                   return SignalValue{rate * t, rate, 0};
                                 }});
  World world(made);
  const Vec start = point(world, 6);
  // The plate turns at full speed at once; friction takes the strand along within a step
  // or two, by a slide that is over at 0.1 s.
  ASSERT_EQ(world.advance(0.1), Status::ok) << world.failure();
  const auto on_plate = [&](double t) {
    return rotation({0, 0, 1}, -rate * t) * point(world, 6);
  };
  const Vec first = on_plate(0.1);
  EXPECT_LT(norm(first - start), 0.01);
  ASSERT_EQ(world.advance(0.6), Status::ok) << world.failure();
  EXPECT_LT(norm(on_plate(0.6) - first), 1e-9);
  EXPECT_GT(norm(point(world, 6) - start), 0.03);
}

/// Held by its root on a plate that turns to and fro by half a radian twice a second: the
/// velocity at the end of a step is not that of the way within it, and a law of it creeps
/// by h omega^2 r/2 per time, 2 mm in a second here.
TEST(StrandFriction, ARootedStrandStaysOnABodyThatTurns) {
  for (const char* const method : {"backward_euler", "linearly_implicit_euler"}) {
    for (const char* const model : {"super_helix", "articulated_chain", "der"}) {
      Set set{.model = model,
              .integrator = method,
              .strands =
                  "[strand]\nlength_m = 0.03\nelements = 5\nroot_tangent = [1, 0, 0]\n"
                  "position_m = [0.02, 0, 1e-3]\n",
              .effects =
                  "[effects.gravity]\n[effects.body]\nfriction_law = \"exact\"\n"
                  "normal = \"rigid\"\nstrand_radius_m = 1e-3\nmoves = \"head\"\n"
                  "friction = 0.9\n",
              .friction = "tolerance_m_s = 1e-12\nsweeps = 10000\n"};
      Scene made = scene(set);
      const RootMotion::Part turn{{0, 0, 1}, one_minus_cosine(0.25, 2)};
      made.head.rotations.push_back(turn);
      made.head.centre = Vec{};
      made.strands[0].root.rotations.push_back(turn);
      made.strands[0].root.centre = Vec{};
      World world(made);
      const Vec start = point(world, 5);
      double farthest = 0;
      for (int i = 1; i <= 10; ++i) {
        ASSERT_EQ(world.advance(0.1 * i), Status::ok) << world.failure();
        const double angle = turn.signal(0.1 * i).value;
        const Vec now = rotation({0, 0, 1}, -angle) * point(world, 5);
        farthest = std::max(farthest, norm(now - start));
      }
      // Forces are those of the linear step; what its places are off is second order in
      // it: 4 um for der by linearly_implicit_euler, whose step is linear about its
      // start.
      const bool linear = std::string(method) == "linearly_implicit_euler";
      EXPECT_LT(farthest, linear ? 1e-5 : 1e-6) << model << ' ' << method;
    }
  }
}

/// A stiff rod across two stiff rails, thrown along them: it loses mu g of its speed per
/// second, stops, and stays.
class Sled : public testing::TestWithParam<const char*> {};

TEST_P(Sled, SlidesAsCoulombSaysAndStays) {
  const double mu = 0.3, g = 9.81, speed = 0.1;
  Set set{.model = GetParam(),
          .strands =
              "[[strand]]\nlength_m = 0.03\nelements = 4\nposition_m = [0, 0.02, 0]\n"
              "[[strand]]\nlength_m = 0.03\nelements = 4\n"
              "position_m = [0, -0.02, 0]\n"
              "[[strand]]\nlength_m = 0.06\nelements = 4\nposition_m = [0.015, "
              "-0.03, 0.002]\nroot_tangent = [0, 1, 0]\nnormal = [1, 0, 0]\n",
          .friction = "friction = 0.3\ntolerance_m_s = 1e-12\nsweeps = 10000\n",
          .material = "ellipticity = 1\nradius_m = 1e-3\n"};
  Scene made = scene(set);
  const RootPose at = made.strands[2].root.at(0);
  made.strands[2].free_root = FreeRoot{at.x, at.frame, {speed, 0, 0}, {}};
  World world(made);
  const std::size_t tip = world.positions().size() / 3 - 1, middle = tip - 2;
  const double start = point(world, middle).x;
  // Steps of backward Euler lose mu g h of speed each, and go on with what is left.
  const double stop = speed / (mu * g);
  ASSERT_EQ(world.advance(0.6 * stop), Status::ok) << world.failure();
  const double half = load3(&world.velocities()[3 * middle]).x;
  EXPECT_NEAR(half, 0.4 * speed, 0.03 * speed);
  ASSERT_EQ(world.advance(1.5 * stop), Status::ok) << world.failure();
  const Vec stopped = point(world, middle);
  // The rails bend under the rod first, by 40 um.
  const double way = speed * speed / (2 * mu * g) - 0.5 * speed * set.step;
  EXPECT_NEAR(stopped.x - start, way, 0.01 * way);
  ASSERT_EQ(world.advance(0.3), Status::ok) << world.failure();
  const Vec rested = point(world, middle);
  ASSERT_EQ(world.advance(0.8), Status::ok) << world.failure();
  // It sticks: what creeps is the tolerance over half a second.
  EXPECT_LT(norm(point(world, middle) - rested), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Models, Sled,
                         testing::Values("super_helix", "der", "corde", "mass_spring",
                                         "inextensible_strand"));

TEST(StrandFriction, KeepsMomentumOfFreeStrands) {
  for (const char* const model : {"der", "mass_spring", "corde"}) {
    Set set{.model = model,
            .strands = crossing(),
            .effects = "",
            .root = "free\"\nvelocity_m_s = [0, 0, 0]\nspin_rad_s = [0, 0, 0]\n#\""};
    Scene made = scene(set);
    made.strands[1].free_root->velocity = {0.05, 0, -0.5};
    const auto momentum = [&](World& world) {
      Vec sum;
      const Snapshot now = world.snapshot();
      for (std::size_t k = 0; k < 2; ++k) {
        const auto twin = made.model->on_strand(made.strands[k], made.model_options, {});
        twin->recall(now.strands[k].memory);
        const auto of_one =
            twin->energetics()->momentum(now.t, now.strands[k].q, now.strands[k].v);
        sum = sum + load3(of_one->linear.data());
      }
      return sum;
    };
    World world(made);
    const Vec before = momentum(world);
    ASSERT_EQ(world.advance(0.05), Status::ok) << world.failure();
    EXPECT_GT(world.stats().contact_iterations, 0);
    EXPECT_GT(distance(world, 0, 1), 0.9e-3);
    // Newton's tolerance, 1e-10 of typical speeds of 1 m/s or more, times mass and steps.
    EXPECT_LT(norm(momentum(world) - before), 1e-7 * norm(before)) << model;
    // The lower one moves now.
    EXPECT_LT(load3(&world.velocities()[3 * 2]).z, -1e-3);
  }
}

TEST(StrandFriction, HoldsAStrandOffItself) {
  // A turn and three quarters that rise by 4 mm in a turn, and sink under their weight.
  std::string coil = "[strand]\nelements = 40\npoints = [";
  for (int k = 0; k <= 14; ++k) {
    const double angle = k * std::numbers::pi / 4;
    coil += fmt::format("{}[{}, {}, {}]", k == 0 ? "" : ", ", 0.01 * std::sin(angle),
                        0.01 * (1 - std::cos(angle)), 0.0005 * k);
  }
  coil += "]\nnormal = [0, 1, 0.1]\n";
  Set set{.strands = coil,
          .material = "ellipticity = 1\nyoungs_modulus_pa = 1e8\n",
          .step = 1e-3};
  const auto least = [](World& world) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 1; i <= 40; ++i) {
      EXPECT_EQ(world.advance(5e-3 * i), Status::ok) << world.failure();
      nearest = std::min(nearest, distance(world, 0, 0, 8));
    }
    return nearest;
  };
  World held(scene(set));
  EXPECT_GT(least(held), 0.94e-3);
  EXPECT_GT(held.friction()->contacts(), 0u);
  set.friction = "thickness_m = 1e-3\nown = \"no\"\n";
  World through(scene(set));
  EXPECT_LT(least(through), 0.5e-3);
}

/// On curved paths, in steps of 3 ms, none comes nearer than by its radius.
TEST(StrandFriction, HoldsShakenGuidesApart) {
  World world(read_scene(TRESS_SCENES "/shaken_guides.toml"));
  const double thickness = 5e-4;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= 12; ++i) {
    ASSERT_EQ(world.advance(0.1 * i), Status::ok) << world.failure();
    for (std::size_t k = 0; k < world.strands(); ++k) {
      for (std::size_t j = k + 1; j < world.strands(); ++j) {
        least = std::min(least, distance(world, k, j));
      }
    }
  }
  EXPECT_GT(world.friction()->contacts(), 100u);
  EXPECT_GT(least, thickness / 2);
  EXPECT_GT(world.friction()->deepest(), 0);
  // At the end of every step: none has passed through another.
  EXPECT_LT(world.friction()->deepest(), thickness);
  EXPECT_LT(world.stats().contact_violation, 1e-3);
}

/// In all steps of scenes in which the law is found.
TEST(StrandFriction, DoesNoWorkOnASlide) {
  for (const char* const model : {"super_helix", "der", "articulated_chain"}) {
    World world(scene({.model = model, .strands = four()}));
    double fastest = 0;
    for (int i = 1; i <= 150; ++i) {
      ASSERT_EQ(world.advance(2e-3 * i), Status::ok) << world.failure();
      fastest = std::max(fastest, world.friction()->drive());
    }
    EXPECT_GT(world.friction()->contacts(), 0u);
    EXPECT_EQ(world.stats().contact_unfinished, 0);
    EXPECT_LE(fastest, 5e-6) << model;  // five times the tolerance
  }
}

/// A few that are stepped as one system rub as they do where each is a system.
TEST(StrandFriction, OfStrandsOfOneSystemIsThatOfEachAlone) {
  constexpr double tolerance = 1e-9, span = 0.15;  // m/s, s
  for (const char* const method : {"linearly_implicit_euler", "backward_euler"}) {
    const auto made = [&](const std::string& options) {
      return scene(
          {.model = "super_helix",
           .options = options,
           .integrator = method,
           .strands = four(),
           .friction = fmt::format("thickness_m = 1e-3\ntolerance_m_s = {}\n", tolerance),
           .step = 5e-4});
    };
    World together(made(one_system)),
        apart(made("jacobian = \"elastic\"\nsolver = \"composite\"\n"));
    ASSERT_EQ(together.systems(), 1u);
    ASSERT_EQ(apart.systems(), 4u);
    for (World* const world : {&together, &apart}) {
      ASSERT_EQ(world->advance(span), Status::ok) << world->failure();
      EXPECT_GT(world->friction()->contacts(), 0u);
    }
    // Both obey the law within the tolerance, in which they may part all the time.
    for (std::size_t i = 0; i < together.positions().size(); ++i) {
      EXPECT_NEAR(together.positions()[i], apart.positions()[i], 2 * tolerance * span);
    }
  }
}

TEST(StrandFriction, ContinuesASnapshotBitByBitOnAnyThreads) {
  for (const Set& set : {Set{.model = "super_helix", .strands = crossing()},
                         Set{.model = "super_helix",
                         .options = one_system,
                         .strands = four(),
                         .step = 1e-3},
                         Set{.model = "der", .strands = crossing()}}) {
    const Scene made = scene(set);
    World whole(made), half(made, 2), rest(made, 3);
    for (int i = 1; i <= 20; ++i) {
      ASSERT_EQ(whole.advance(0.01 * i), Status::ok);
      if (i <= 10) {
        ASSERT_EQ(half.advance(0.01 * i), Status::ok);
      }
      if (i == 10) {
        whole.restore(whole.snapshot());
        rest.restore(half.snapshot());
      }
      if (i > 10) {
        ASSERT_EQ(rest.advance(0.01 * i), Status::ok);
      }
    }
    EXPECT_GT(whole.friction()->contacts(), 0u);
    EXPECT_EQ(whole.positions(), rest.positions()) << set.model << whole.systems();
    EXPECT_EQ(whole.friction()->deepest(), rest.friction()->deepest());
  }
}

}  // namespace tress::test_strand_friction
