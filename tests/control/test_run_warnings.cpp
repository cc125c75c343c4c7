// What a run finds wrong with itself: energy that its method took or made, forces that
// jump.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

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

TEST(NotSmooth, IsNotSaidOfOtherStrands) {
  const std::string bdf2 = "id = \"bdf2\"\ndt_s = 0.001";
  EXPECT_EQ(run_of(hair("lifted_curls", bdf2, "length_m = 0.1\n", gravity)).not_smooth,
            "");
  EXPECT_EQ(run_of(hair("mass_spring", bdf2, "length_m = 0.1\n", gravity)).not_smooth,
            "");
  EXPECT_EQ(run_of(hair("der", bdf2, curls, gravity)).not_smooth, "");
  EXPECT_EQ(run_of(hair("super_helix", bdf2, curls, gravity)).not_smooth, "");
}

}  // namespace tress::test_run_warnings
