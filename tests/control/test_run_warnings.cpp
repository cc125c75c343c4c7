// What a run finds wrong with itself: energy that its method took or made, forces that
// jump.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "experiments/simulate/outcome.h"
#include "experiments/simulate/starts_inside.h"
#include "experiments/simulate/warnings.h"
#include "simulation/run/world.h"

namespace tress::test_run_warnings {

using namespace simulation;
using experiments::scene_runs::SceneRun;
using experiments::scene_runs::warnings;

SceneRun run_of(const Scene& scene) {
  SceneRun run{SceneRun::End::complete, {}, 0, 0, 0, 0};
  World world(scene);
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    EXPECT_EQ(world.advance(scene.time_of(frame)), Status::ok) << world.failure();
  }
  run.dissipation = world.dissipation();
  run.excess = world.excess();
  run.not_smooth = world.not_smooth();
  return run;
}

Scene hair(const std::string& model, const std::string& integrator,
           const std::string& strand, const std::string& effects) {
  return parse_scene(
      "title = \"t\"\nduration_s = 0.3\nframes_per_s = 60\n[model]\nid = \"" + model +
          "\"\n[integrator]\n" + integrator +
          "\n[material]\nname = \"hair.asian\"\n[strand]\nelements = 10\n" +
          "root_tangent = [1, 0, 0]\n" + strand + effects,
      "warned.toml");
}

const std::string gravity = "[effects.gravity]\n";

TEST(MethodDissipation, ShowsWhatAMethodDissipates) {
  const std::string euler = "id = \"backward_euler\"\ndt_s = 0.005";
  const Scene scene = hair("der", euler, "", gravity);
  const SceneRun run = run_of(scene);
  ASSERT_TRUE(run.dissipation);
  EXPECT_GT(run.dissipation->share(), 0.1);
  EXPECT_LT(run.dissipation->share(), 1);
  const auto said = warnings(scene, run);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("backward_euler dissipated"), std::string::npos) << said[0];
}

/// A free strand at rest that nothing holds falls, as one body: that is no motion of
/// hair.
TEST(FreeStrands, AreNamedIfNothingHoldsThem) {
  const std::string euler = "id = \"bdf2\"\ndt_s = 0.005", free = "root = \"free\"\n";
  const auto said = [&](const std::string& strand, const std::string& rest) {
    const auto all = warnings(hair("der", euler, strand, rest),
                              SceneRun{SceneRun::End::complete, {}, 0, 0, 0, 0});
    return all.empty() ? "" : all.front();
  };
  EXPECT_NE(said(free, gravity).find("strand 0 has a free root"), std::string::npos);
  EXPECT_NE(said("", "[root]\nmotion = \"free\"\n" + gravity).find("falls"),
            std::string::npos);
  EXPECT_EQ(said("", gravity), "");
  EXPECT_EQ(said(free, ""), "");
  EXPECT_EQ(said("", "[root]\nmotion = \"free\"\nspin_rad_s = [0, 1, 0]\n" + gravity),
            "");
  EXPECT_EQ(said(free, gravity + "[effects.body]\n"), "");
  EXPECT_EQ(said(free, gravity + "[[supports]]\nstrand = 0\nat = \"tip\"\n"), "");
}

/// With friction, drag and a shaken root, which all are accounted for. The energy of an
/// accurate run changes by what these do; the trapezoidal rule errs by (4 h w)^2/12 of
/// their work for powers of the rate w, here below 1e-2 for the slow motion that has the
/// energy.
TEST(MethodDissipation, BalancesForAnAccurateMethod) {
  const std::string driven = "[root]\nmotion = \"shake\"\namplitude_m = 0.02\n" +
                             gravity + "[effects.linear_drag]\ndrag_kg_m_s = 1e-5\n";
  for (const char* const model : {"super_helix", "der", "mass_spring"}) {
    const Scene scene = hair(model, "id = \"esdirk43\"\ndt_s = 0.0005", "", driven);
    const SceneRun run = run_of(scene);
    ASSERT_TRUE(run.dissipation);
    EXPECT_LT(std::abs(run.dissipation->share()), 0.02) << model;
    EXPECT_TRUE(warnings(scene, run).empty());
  }
}

/// Steps of 31 ms, after each of which powers are seen once: runs at a tolerance of 1e-5
/// differ by 5.6e-10 J, and the account is off by 8.3e-8 J.
TEST(MethodDissipation, IsNotSaidWhereTheQuadratureDoesNotDecide) {
  const Scene curl = parse_scene(
      "title = \"curl\"\nduration_s = 0.5\nframes_per_s = 50\n[model]\n"
      "id = \"super_helix\"\njacobian = \"elastic\"\n[integrator]\nid = \"tr_bdf2\"\n"
      "position_tol_rel = 0.1\n[material]\ninternal_friction_kg_m3_s = 1e-10\n"
      "[strand]\nlength_m = 0.09\nelements = 13\nshape = \"helix\"\n"
      "curl_radius_m = 0.008\ncurl_pitch_m = 0.03\n[root]\nmotion = \"shake\"\n"
      "amplitude_m = 0.01\nfrequency_hz = 3\n[effects.gravity]\n[effects.linear_drag]\n"
      "drag_kg_m_s = 4e-5\n[effects.wind]\nvelocity_m_s = [0.5, 0.2, 0]\n",
      "curl.toml");
  const SceneRun run = run_of(curl);
  EXPECT_GT(std::abs(run.dissipation->share()), 0.5);
  EXPECT_TRUE(warnings(curl, run).empty()) << warnings(curl, run)[0];
}

/// Impacts and slip between two checks: a run with a step of 50 us differs by 1.2e-9 J.
TEST(MethodDissipation, IsNotSaidOfContactBetweenTwoChecks) {
  const Scene ball = parse_scene(
      "title = \"ball\"\nduration_s = 0.5\n[model]\nid = \"super_helix\"\n"
      "[integrator]\nid = \"backward_euler\"\ndt_s = 0.001\n[strand]\nlength_m = 0.12\n"
      "elements = 24\nposition_m = [0, 0, 0.06]\n[root]\n[effects.gravity]\n"
      "[effects.linear_drag]\ndrag_kg_m_s = 3e-5\n[effects.body]\nshape = \"sphere\"\n"
      "radius_m = 0.03\ncentre_m = [0.04, 0.005, 0]\n",
      "ball.toml");
  const SceneRun run = run_of(ball);
  EXPECT_TRUE(warnings(ball, run).empty()) << warnings(ball, run)[0];
}

/// A curl without load whose energies are roundings, and one at rest under gravity.
TEST(MethodDissipation, IsNotSaidOfAStrandAtRest) {
  for (const char* const more : {"", "[effects.gravity]\n"}) {
    const Scene still = parse_scene(
        "title = \"still\"\nduration_s = 0.2\nframes_per_s = 10\n" +
            std::string(*more == 0 ? "" : "rest = \"inverse\"\n") +
            "[model]\nid = \"corde\"\n[integrator]\nid = \"backward_euler\"\n"
            "dt_s = 0.005\n[strand]\nlength_m = 0.15\nelements = 20\nshape = \"helix\"\n"
            "curl_radius_m = 0.01\ncurl_pitch_m = 0.02\nroot_tangent = [0, 0, -1]\n" +
            more,
        "still.toml");
    const SceneRun run = run_of(still);
    EXPECT_TRUE(warnings(still, run).empty()) << warnings(still, run)[0];
    EXPECT_LE(std::abs(run.dissipation->share()), 1);
  }
}

/// The highest energy is that of the start, and not that of the motion afterwards.
TEST(MethodDissipation, IsAPartOfTheEnergyOfTheStart) {
  DissipationMeter meter;
  meter.start({0, 1}, 0);
  meter.gather(1, {1e-9, 1e-3}, 0);
  meter.gather(1, {0, 1e-3}, 0);
  EXPECT_NEAR(meter.dissipation(1).share(), 1, 1e-12);
  EXPECT_EQ(meter.dissipation(1).uncertain, 0);
}

/// Power rises from 0 to 2 W in 1 s, somehow: 0 to 2 J of work.
TEST(MethodDissipation, KnowsWhatItsQuadratureDoesNot) {
  DissipationMeter meter;
  meter.start({2, 0}, 0);
  meter.gather(1, {3.5, 0}, 2);
  EXPECT_DOUBLE_EQ(meter.dissipation(1).dissipated, -0.5);
  EXPECT_DOUBLE_EQ(meter.dissipation(1).uncertain, 2);
  EXPECT_EQ(meter.dissipation(1).proven(), 0);
}

TEST(MethodDissipation, HasARemedyThatFitsTheMethod) {
  const auto said = [](const std::string& model, const std::string& integrator) {
    const Scene scene = hair(model, integrator, "", gravity);
    SceneRun run{SceneRun::End::complete, {}, 0, 0, 0, 0};
    run.dissipation = {1e-8, 1e-10, 2e-8, 1};
    const auto all = warnings(scene, run);
    return all.empty() ? "" : all[0].substr(all[0].find("motion: ") + 8);
  };
  EXPECT_EQ(said("der", "id = \"tr_bdf2\"\ndt_s = 0.002"), "take a shorter dt_s");
  EXPECT_EQ(said("der", "id = \"tr_bdf2\"\nposition_tol_rel = 0.01"),
            "take a smaller tolerance");
  EXPECT_EQ(said("der", "id = \"backward_euler\"\ndt_s = 0.002"),
            "take a shorter dt_s, or a method of order 2, such as tr_bdf2");
  EXPECT_EQ(said("mass_spring", "id = \"xpbd\"\ndt_s = 0.002"),
            "take more sweeps, or a method that solves its steps, such as tr_bdf2");
}

TEST(MethodDissipation, GoesOnFromASnapshot) {
  const Scene scene = hair("der", "id = \"backward_euler\"\ndt_s = 0.005", "", gravity);
  World whole(scene), first(scene), second(scene);
  for (std::size_t frame = 1; frame <= 12; ++frame) {
    EXPECT_EQ(whole.advance(scene.time_of(frame)), Status::ok);
    if (frame == 6) second.restore(whole.snapshot());
    if (frame > 6) {
      EXPECT_EQ(second.advance(scene.time_of(frame)), Status::ok);
    }
  }
  EXPECT_NEAR(second.dissipation()->dissipated, whole.dissipation()->dissipated,
              1e-12 * whole.dissipation()->available);
}

TEST(MethodDissipation, IsEmptyWhereImpulsesAct) {
  const Scene scene =
      hair("der", "id = \"backward_euler\"\ndt_s = 0.005", "",
           gravity +
               "[effects.body]\nshape = \"plane\"\ncentre_m = [0, 0, -1]\n"
               "friction_law = \"exact\"\nnormal = \"rigid\"\n");
  EXPECT_FALSE(run_of(scene).dissipation);
}

/// A body that a hair falls on in steps of 10 ms gives it energy that it has not: within
/// the slack of the guard, and not without a word.
TEST(EnergyExcess, IsPrintedWhereTheGuardAllowsIt) {
  const Scene scene = parse_scene(
      "title = \"t\"\nduration_s = 0.6\nframes_per_s = 50\n[model]\nid = "
      "\"super_helix\"\n[integrator]\nid = \"newmark\"\ndt_s = 0.01\n[material]\n"
      "name = \"custom\"\nradius_m = 4e-5\nyoungs_modulus_pa = 4e9\n"
      "density_kg_m3 = 1300\npoisson_ratio = 0.3\ninternal_friction_kg_m3_s = 0\n"
      "[strand]\nlength_m = 0.1\nelements = 8\nroot_tangent = [1, 0, 0.3]\n"
      "[effects.gravity]\n[effects.body]\nshape = \"plane\"\n"
      "centre_m = [0, 0, -0.03]\nfriction = 0\n",
      "excess.toml");
  const SceneRun run = run_of(scene);
  EXPECT_GT(run.excess.share(), 0.1);
  EXPECT_LE(run.excess.share(), 1);
  // The account of the method does not decide here: its bound is nearly as large.
  SceneRun undecided = run;
  undecided.dissipation.reset();
  const auto said = warnings(scene, undecided);
  ASSERT_FALSE(said.empty());
  EXPECT_NE(said[0].find("more energy than its start and its loads explain"),
            std::string::npos)
      << said[0];
}

const std::string curls =
    "length_m = 0.2\nshape = \"helix\"\ncurl_radius_m = 0.005\ncurl_pitch_m = 0.02\n";

/// A curl much softer than its weight: joints are pulled straight and bend the other way.
TEST(NotSmooth, IsSaidOfAnglesThatLoseTheirDirection) {
  const Scene scene = hair("lifted_curls", "id = \"bdf2\"\ndt_s = 0.001", curls,
                           "[strand.material]\nname = \"hair.asian\"\n"
                           "youngs_modulus_pa = 1e7\n" +
                               gravity);
  const SceneRun run = run_of(scene);
  EXPECT_NE(run.not_smooth.find("strand 0: forces at joints jumped"), std::string::npos)
      << run.not_smooth;
  const auto said = warnings(scene, run);
  ASSERT_FALSE(said.empty());
  EXPECT_NE(said.back().find("the motion is not smooth"), std::string::npos);
}

TEST(StepsInWords, OfAResumedRunAreThoseSinceThen) {
  Scene scene;
  scene.options.tolerance = 1e-3;
  SceneRun run{SceneRun::End::complete, {}, 0, 0, 0, 0};
  run.work.steps = 7;
  using experiments::scene_runs::control_in_words;
  EXPECT_EQ(control_in_words(scene, run).find("; 7 steps, 0 rejected"), 0U);
  run.resumed = true;
  EXPECT_EQ(control_in_words(scene, run).find("; 7 steps since the run was resumed, 0"),
            0U);
}

TEST(NotSmooth, IsNotSaidOfOtherStrands) {
  const std::string bdf2 = "id = \"bdf2\"\ndt_s = 0.001";
  EXPECT_EQ(run_of(hair("lifted_curls", bdf2, "length_m = 0.1\n", gravity)).not_smooth,
            "");
  EXPECT_EQ(run_of(hair("mass_spring", bdf2, "length_m = 0.1\n", gravity)).not_smooth,
            "");
  EXPECT_EQ(run_of(hair("der", bdf2, curls, gravity)).not_smooth, "");
  EXPECT_EQ(run_of(hair("super_helix", bdf2, curls, gravity)).not_smooth, "");
}

using experiments::scene_runs::StartsInside;

std::vector<std::string> said_of_start(const Scene& scene) {
  World world(scene);
  StartsInside inside(scene);
  std::size_t first = 0;
  for (const int points : world.points()) {
    const auto numbers = 3 * static_cast<std::size_t>(points);
    inside.look(In(world.positions()).subspan(first, numbers));
    first += numbers;
  }
  return inside.warnings();
}

std::string on_sphere(const std::string& strands, const std::string& more) {
  return "title = \"t\"\nduration_s = 0.1\n[integrator]\nid = \"backward_euler\"\n"
         "dt_s = 0.001\n" +
         strands + "[root]\n[effects.gravity]\n[effects.body]\nshape = \"sphere\"\n" +
         "radius_m = 0.03\n" + more;
}
const std::string down =
    "[[strand]]\nlength_m = 0.1\nelements = 12\nroot_tangent = [0, 0, -1]\n";
const std::string aside =
    "[[strand]]\nlength_m = 0.1\nelements = 12\nposition_m = [1, 0, 0]\n"
    "root_tangent = [0, 0, -1]\n";

/// Point 6 is at z = -0.05, sqrt(17) mm from the centre of a sphere of 30 mm.
TEST(StartsInside, SaysWhichStrandIsHowDeepInWhichBody) {
  const std::string near = "centre_m = [0.004, 0.001, -0.05]\n";
  const auto single = said_of_start(parse_scene(on_sphere(down, near), "in.toml"));
  ASSERT_EQ(single.size(), 1U);
  EXPECT_EQ(single[0],
            "strand 0 begins 0.0259 m inside body (point 6), and contact assumes a start "
            "outside: the surface expels it with energy that no load has given; move the "
            "strand or the body");
  const auto rigid = said_of_start(parse_scene(
      on_sphere(aside + down, near + "friction_law = \"exact\"\nnormal = \"rigid\"\n"),
      "in.toml"));
  ASSERT_EQ(rigid.size(), 1U);
  EXPECT_EQ(rigid[0],
            "strand 1 begins 0.0259 m inside body (point 6, the deepest of 1 of 2 "
            "strands), and contact assumes a start outside: a rigid surface does not "
            "bring it out; move the strand or the body");
}

/// Roots at a scalp, and a strand that lies on the surface with its axis or its skin.
TEST(StartsInside, SaysNothingOfRootsAndOfTheSurface) {
  const auto on = [](double z) {
    return said_of_start(parse_scene(
        on_sphere(down, "centre_m = [0, 0, " + std::to_string(z) + "]\n"), "on.toml"));
  };
  EXPECT_TRUE(on(0.03).empty());
  EXPECT_TRUE(on(0.025).empty());  // the root alone is inside, by 5 mm
  EXPECT_FALSE(on(0.02).empty());  // so is point 1, by 1.7 mm
}

/// A mooring that finds its equilibrium on the floor z = 0 lies in its elastic layer,
/// deeper than rounding: its weight per length over the stiffness of the layer of 1
/// N/m^2.
TEST(StartsInside, SaysNothingOfAMooringInEquilibriumOnTheFloor) {
  const Scene scene = parse_scene(
      "title = \"t\"\nduration_s = 0.1\n[integrator]\nid = \"backward_euler\"\n"
      "dt_s = 0.02\n[material]\nname = \"custom\"\nradius_m = 4e-5\n"
      "youngs_modulus_pa = 3e5\npoisson_ratio = 0.45\ndensity_kg_m3 = 1300\n"
      "[strand]\nlength_m = 1\nelements = 20\n[root]\nmotion = \"free\"\n"
      "[[supports]]\nat = \"root\"\n[[supports]]\nat = \"tip\"\n"
      "keyframes = [[0, 0.8, 0, 0.45]]\n[effects.gravity]\n[effects.body]\n"
      "friction = 0\nstrand_radius_m = 0\nstiffness_n_m2 = 1\n",
      "mooring.toml");
  World world(scene);
  double lowest = 0;
  for (std::size_t i = 2; i < world.positions().size(); i += 3) {
    lowest = std::min(lowest, world.positions()[i]);
  }
  EXPECT_LE(lowest, -1e-5);
  EXPECT_TRUE(said_of_start(scene).empty());
}

}  // namespace tress::test_run_warnings
