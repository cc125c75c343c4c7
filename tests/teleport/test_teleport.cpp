// Roots that jump and carry their strands: nothing changes in the frame of the root.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "models/maximal/edge_reference.h"
#include "models/motion/signals.h"
#include "simulation/head/head_run.h"
#include "simulation/head/scene_head.h"
#include "tests/support/refusal.h"
#include "tests/teleport/teleport_scenes.h"

namespace tress::test_teleport {

using testing_support::refusal;

/// A root that moves, and jumps while it moves.
const std::string moving =
    "motion = \"poses\"\nposes = [[0, 0, 0, 0, 0, 0, 0], [0.02, 0.01, 0, 0, 0.1, 0, "
    "0.2], [0.05, 0.02, 0.01, 0, 0.2, 0.1, 0.3], [0.05, 0.5, -0.2, 0.3, 1.2, -0.7, 2], "
    "[0.08, 0.5, -0.1, 0.3, 1.1, -0.4, 2.1]]\n";

class Teleport : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Models, Teleport, testing::ValuesIn(strand_models()),
                         [](const auto& tested) { return tested.param; });

/// Places are sums of a few products of numbers below 1 m; the root is evaluated 8
/// roundings earlier than the strand. Velocities are below 20 m/s, and those of reduced
/// models sums along the strand.
TEST_P(Teleport, CarriesPlacesVelocitiesAndElasticEnergyWithTheRoot) {
  // The moving root makes dynamic_spline unstable in longer steps.
  const bool short_steps = GetParam() == "dynamic_spline";
  const std::string method =
      short_steps ? "id = \"backward_euler\"\ndt_s = 1e-4" : steps("backward_euler");
  const Scene scene = scene_of(GetParam(), method, moving, strand);
  World world(scene);
  const Displacement by = jump_of(scene);
  ASSERT_GT(norm(by.spin()), 1);
  const double before = models::just_before(models::teleport_time(jump_at));
  ASSERT_EQ(world.advance(before), Status::ok) << world.failure();
  const Points expected = carried(by, points_of(world));
  const Energies energies = world.energies();
  ASSERT_EQ(world.advance(jump_at), Status::ok) << world.failure();
  const Points now = points_of(world);
  EXPECT_LE(apart(now.x, expected.x), 100 * epsilon);
  EXPECT_LE(apart(now.u, expected.u), 20 * 100 * epsilon);
  // A length that is off by a rounding of 1 m changes the energy by that times the
  // tension, which is below the weight of a hair's hundredfold, 1e-4 N.
  EXPECT_NEAR(world.energies().elastic, energies.elastic,
              1e-11 * energies.elastic + 6 * 1e-4 * epsilon);
}

/// Where the root rests before and after, kinetic energy does not change either.
TEST_P(Teleport, AddsNoEnergyWhereTheRootRests) {
  const Scene scene = scene_of(GetParam(), steps("backward_euler"), aside, strand);
  World world(scene);
  ASSERT_EQ(world.advance(models::just_before(models::teleport_time(jump_at))),
            Status::ok);
  const Energies before = world.energies();
  ASSERT_EQ(world.advance(jump_at), Status::ok) << world.failure();
  const Energies after = world.energies();
  EXPECT_GT(before.kinetic, 1e-9);
  EXPECT_NEAR(after.kinetic, before.kinetic, 1e-12 * before.kinetic);
  EXPECT_NEAR(after.elastic, before.elastic, 1e-11 * before.elastic + 6 * 1e-4 * epsilon);
}

/// Newton's method ends within 1e-10 of typical sizes in each of 100 steps, and the
/// motion amplifies differences by less than ten: 1e-10 * 100 * 10 of a length.
TEST_P(Teleport, LeavesTheMotionAsItIsWhereGravityDoesNotSeeIt) {
  for (const char* const method :
       {"linearly_implicit_euler", "backward_euler", "bdf2", "tr_bdf2"}) {
    SCOPED_TRACE(method);
    const auto end = [&](const std::string& root) {
      World world(scene_of(GetParam(), steps(method), root, strand));
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      return points_of(world);
    };
    const Scene scene = scene_of(GetParam(), steps(method), aside, strand);
    const Points jumped = end(aside), stayed = end(nowhere);
    EXPECT_LE(apart(jumped.x, carried(jump_of(scene), stayed).x), 1e-7 * length);
  }
}

/// The end of a step is where the rows say, whatever the step: a jump within one divides
/// it. With a tolerance of 1e-4 of the length, both runs are that near to the solution.
TEST(Teleport, DividesStepsAndFollowsTolerances) {
  for (const char* const method :
       {"id = \"tr_bdf2\"\nposition_tol_rel = 1e-4", "id = \"cvode_bdf\"\nrtol = 1e-7",
        "id = \"backward_euler\"\ndt_s = 7e-3", "id = \"arkode_dirk\"\nrtol = 1e-7",
        "id = \"generalized_alpha\"\ndt_s = 1e-3"}) {
    SCOPED_TRACE(method);
    const auto end = [&](const std::string& root) {
      World world(scene_of("super_helix", method, root, strand));
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      return points_of(world);
    };
    const Scene scene = scene_of("super_helix", method, aside, strand);
    const Points expected = carried(jump_of(scene), end(nowhere));
    EXPECT_LE(apart(end(aside).x, expected.x), 2e-4 * length);
  }
}

/// One step after the other, a jump to the same place changes nothing at all.
TEST(Teleport, ToTheSamePlaceChangesNothing) {
  for (const char* const model : {"super_helix", "der", "mass_spring"}) {
    const auto end = [&](const std::string& root) {
      World world(scene_of(model, steps("backward_euler"), root, strand));
      EXPECT_EQ(world.advance(jump_at), Status::ok);
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      return points_of(world);
    };
    EXPECT_LE(apart(end(nowhere).x, end("motion = \"fixed\"\n").x), 1e-7 * length);
  }
}

/// The potential of gravity changes by fifty times what a guard lets a strand gain, and
/// the account of what the method dissipates leaves it out. Places of 5 m have roundings
/// of 1e-15 m, which stretching turns into energies of less than a thousandth.
TEST(Teleport, IsNoEnergyThatAGuardMisses) {
  for (const char* const model : {"super_helix", "der"}) {
    SCOPED_TRACE(model);
    const auto dissipated = [&](const std::string& height) {
      World world(scene_of(model, steps("backward_euler"), to("0, 0, " + height + ", 0"),
                           strand));
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      EXPECT_TRUE(world.dissipation());
      return world.dissipation()->dissipated;
    };
    const double stays = dissipated("0");
    EXPECT_GT(stays, 0);
    EXPECT_NEAR(dissipated("5"), stays, 1e-3 * stays);
    EXPECT_NEAR(dissipated("-5"), stays, 1e-3 * stays);
  }
}

/// A batch has the strands of a World: bit for bit, since both advance them alone.
TEST(Teleport, CarriesABatchAsSingleStrands) {
  for (const char* const model : {"super_helix", "der", "corde"}) {
    SCOPED_TRACE(model);
    const std::string groom = "[groom]\ncount = 9\nlength_m = 0.1\nelements = 5\n";
    const Scene scene = scene_of(model, steps("backward_euler"), moving, groom);
    World world(scene);
    SceneHead made = make_head(scene, {}, 2);
    EXPECT_FALSE(made.lanes);
    HeadRun run(std::move(made), 2);
    double t = 0;
    for (const double end : {0.03125, 0.0625, 0.09375}) {
      ASSERT_EQ(world.advance(end), Status::ok) << world.failure();
      run.step(t, end - t);
      t = end;
      std::vector<double> x;
      run.positions(t, x);
      EXPECT_EQ(x, world.positions());
    }
  }
}

/// Strands that touch see each other either before the jump or after it. With a tolerance
/// of 1e-3 of the length both runs are that near to the solution, in steps that rounding
/// may change.
TEST(Teleport, CarriesStrandsThatTouch) {
  const auto scene = [&](const std::string& method, const std::string& coupling,
                         const std::string& root) {
    return scene_of("der", method, root,
                    "[[strand]]\nlength_m = 0.1\nelements = 6\n[[strand]]\n"
                    "length_m = 0.1\nelements = 6\nposition_m = [0, 0.002, -0.0005]\n"
                    "root_tangent = [1, 0, 0.02]\n"
                    "[effects.strand_interaction]\ncoupling = \"" +
                        coupling + "\"\n");
  };
  const struct {
    std::string method;
    double within;  // of the length
  } ways[] = {{steps("backward_euler"), 1e-7},
              {steps("tr_bdf2"), 1e-7},
              {steps("esdirk43"), 1e-7},
              {"id = \"tr_bdf2\"\nposition_tol_rel = 1e-3", 2e-3}};
  for (const char* const coupling : {"lagged", "monolithic"}) {
    for (const auto& [method, within] : ways) {
      SCOPED_TRACE(coupling + (", " + method));
      const auto end = [&](const std::string& root) {
        World world(scene(method, coupling, root));
        EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
        return points_of(world);
      };
      const Points expected =
          carried(jump_of(scene(method, coupling, aside)), end(nowhere));
      EXPECT_LE(apart(end(aside).x, expected.x), within * length);
    }
  }
}

/// A body of the head that the strand rests on jumps with it, for stages of esdirk43
/// beyond the end of a step, too. Forces of exact contact are found again, to its
/// tolerance of 1e-8 m/s over 100 steps of 1 ms.
TEST(Teleport, CarriesContactWithABodyOfTheHead) {
  for (const auto& [law, method] :
       {std::pair<std::string, std::string>{"", "backward_euler"},
        {"friction_law = \"exact\"\n", "backward_euler"},
        {"", "esdirk43"}}) {
    SCOPED_TRACE(law + method);
    const std::string body =
        strand +
        "[[effects.body]]\nshape = \"plane\"\ncentre_m = [0, 0, -0.002]\nmoves = "
        "\"head\"\nfriction = 0.3\n" +
        law;
    const auto end = [&](const std::string& root) {
      World world(scene_of("super_helix", steps(method), root, body));
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      return points_of(world);
    };
    const Scene scene = scene_of("super_helix", steps(method), aside, body);
    const Points stayed = end(nowhere);
    EXPECT_LE(apart(end(aside).x, carried(jump_of(scene), stayed).x), 1e-6 * length);
  }
}

/// The sphere lies on the straight way of the strand, which no teleport takes.
TEST(Teleport, PassesThroughNoBody) {
  for (const char* model : {"super_helix", "der"}) {
    const Scene scene = scene_of(model, steps("backward_euler"), to("0.4, 0, 0, 0"),
                                 strand +
                                     "[effects.body]\nshape = \"sphere\"\nradius_m = "
                                     "0.05\ncentre_m = [0.25, 0, -0.02]\n");
    World world(scene);
    static_cast<void>(world.take_depth());  // from here on the depth is watched
    ASSERT_EQ(world.advance(0.06), Status::ok) << world.failure();
    EXPECT_FALSE(world.passed()) << model;
    EXPECT_EQ(world.take_depth(), 0) << model;
  }
}

/// An edge's spin after the jump is the spin before it, turned, plus that of the root.
TEST(Displacement, CarriesTheSpinOfAnEdge) {
  models::RootMotion root = models::keyframe_motion(
      std::vector<double>{0, 0,   0, 0, 0, 0,   0,  1, 0.1, 0, 0, 0.3, 0,   0.5,
                          1, 0.4, 2, 0, 1, 0.5, -2, 2, 0.5, 1, 0, 2,   0.1, -1},
      models::world_axes, {});
  const Displacement by = models::displacement(root, models::teleport_time(1));
  ASSERT_GT(norm(by.spin()), 1);
  Frame reference = rotation({0, 0.6, 0.8}, 0.4);
  const Vec e{0.01, 0.004, 0.003}, de{0.1, -0.2, 0.3};
  double rate = 3;
  const Vec before = models::EdgeTurn(reference.e0, e).spin(de, rate);
  models::displace(by, by.turn * e, reference, rate);
  const Vec de_after = by.turn * de + cross(by.spin(), by.turn * e);
  const Vec after = models::EdgeTurn(reference.e0, by.turn * e).spin(de_after, rate);
  EXPECT_LE(norm(after - (by.turn * before + by.spin())), 1e-12);  // of 40 rad/s
}

TEST(Teleport, RefusesWhatCannotBeCarried) {
  const auto refused = [](const std::string& root, const std::string& rest) {
    return refusal(
        [&] { scene_of("super_helix", steps("backward_euler"), root, strand + rest); });
  };
  const auto expect = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  };
  EXPECT_EQ(refused(aside, ""), "");
  const std::string rows = "motion = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], ";
  expect(refused(rows + "[1, 0, 0, 0, 0], [1, 1, 0, 0, 0], [1, 2, 0, 0, 0]]\n", ""),
         "keyframe 4 is the third at 1 s");
  expect(refused(rows + "[1, 0, 0, 0, 0], [0.5, 1, 0, 0, 0]]\n", ""),
         "keyframe 3 at 0.5 s is not later than keyframe 2 at 1 s");
  expect(refused(rows + "[nan, 0, 0, 0, 0]]\n", ""), "keyframes");
  expect(refused(aside, "[effects.tether]\n"), "tether, which holds a point");
  expect(refused("motion = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], [0.05, 0, 0, 0, "
                 "0], [0.05, 1, 0, 0, 0]]\n",
                 "root = \"free\"\n"),
         "a strand with a free root, which stays where it is");
  expect(refused(aside,
                 "[[supports]]\nstrand = 0\nat = \"tip\"\nkind = "
                 "\"ball\"\n"),
         "teleports with [supports]");
  expect(refused("motion = \"fixed\"\n",
                 "[[effects.body]]\nmoves = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], "
                 "[0.05, 0, 0, 0, 0], [0.05, 1, 0, 0, 0]]\n"),
         "when the roots do not");
}

}  // namespace tress::test_teleport
