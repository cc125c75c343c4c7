#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/gradient/scene_gradient.h"
#include "simulation/run/world.h"
#include "tests/support/apart.h"
#include "tests/support/refusal.h"

namespace tress::test_support_gradient {

using namespace simulation;
using testing_support::refusal;

std::string text(const std::string& model, const std::string& support) {
  return "title = \"t\"\nduration_s = 0.12\nframes_per_s = 50\n[model]\nid = \"" + model +
         "\"\n[integrator]\nid = \"tr_bdf2\"\ndt_s = 0.002\nnewton_tolerance = "
         "1e-13\n[material]\ninternal_friction_kg_m3_s = 1e-10\n[strand]\nlength_m = "
         "0.1\nelements = 6\nshape = \"helix\"\ncurl_radius_m = 0.01\ncurl_pitch_m = "
         "0.03\n[root]\nmotion = \"shake\"\namplitude_m = 0.01\nfrequency_hz = "
         "4\n[effects.gravity]\ngravity_m_s2 = [0.5, 0.2, -9.81]\n"
         "[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n" +
         support +
         "[gradient]\nstart = \"as_run\"\nby = [\"youngs_modulus_pa\", "
         "\"density_kg_m3\", \"radius_m\", \"linear_drag.drag_kg_m_s\", "
         "\"root_position_m.z\", \"natural_curvature_per_m\"]\n";
}

/// Derivatives of the last points against central differences of runs over the part `e`
/// of the measures, within this part of the largest.
void expect_differences(const Scene& scene, double e, double bar) {
  const auto last_points = [](const Scene& one) {
    return scene_gradient(one).strands.front().points.back();
  };
  check_gradient(scene);
  const SceneGradient found = scene_gradient(scene);
  const StrandGradient& strand = found.strands.front();
  ASSERT_EQ(strand.unfinished, "");
  World world(scene, 1);
  ASSERT_EQ(world.advance(scene.duration), Status::ok);
  // World is the run; it solves with the same tolerance.
  EXPECT_LT(apart(world.positions(), strand.points.back()), 1e-9);
  for (std::size_t k = 0; k < found.parameters.size(); ++k) {
    const SceneParameter& by = found.parameters[k];
    const auto at = [&](double s) {
      Scene changed = scene;
      by.change(changed, s);
      return last_points(changed);
    };
    const auto p1 = at(e), m1 = at(-e), p2 = at(2 * e), m2 = at(-2 * e);
    double worst = 0, most = 0;
    for (std::size_t i = 0; i < p1.size(); ++i) {
      const double d = (8 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12 * e * by.measure);
      worst = std::max(worst, std::abs(strand.by[k].back()[i] - d));
      most = std::max(most, std::abs(d));
    }
    EXPECT_GT(most * by.measure, 1e-7) << by.name;
    EXPECT_LT(worst, bar * most) << by.name;
  }
}

// A support without keyframes holds the place where the strand begins, which moves with
// the root. Differences see Newton's tolerance, 1e-13 of the typical sizes in each of 30
// steps, over 1e-4 of the values, of which a thousandth and more reaches the points.
TEST(SupportGradient, OfCompliantSupportsIsThatOfDifferencesOfRuns) {
  const std::string at_tip =
      "[[supports]]\nat = \"tip\"\nkind = \"ball\"\nstiffness_n_per_m = "
      "0.01\ndamping_n_s_per_m = 1e-5\n";
  const std::string moving =
      "[[supports]]\nat = 0.5\nkind = \"ball\"\nstiffness_n_per_m = 1e-4\nkeyframes = "
      "[[0, 0.05, 0, 0], [0.05, 0.05, 0.01, 0.01]]\n";
  for (const std::string model : {"super_helix", "der", "corde"}) {
    for (const std::string& support : {at_tip, moving}) {
      SCOPED_TRACE(model + ", " + support);
      expect_differences(parse_scene(text(model, support), "s.toml"), 1e-4, 1e-5);
    }
  }
}

// The ring is outside of a curl, whose elements slide through it: for some steps the
// nearest place is a point between two elements. A longer way of differences would bring
// the end of these steps to another one. Newton's tolerance over 2e-6 of the values is
// 50 times the one above.
TEST(RingGradient, IsThatOfDifferencesOfRuns) {
  for (const std::string model : {"super_helix", "der"}) {
    for (const std::string damping : {"0", "1e-5"}) {
      SCOPED_TRACE(model + ", " + damping);
      expect_differences(
          parse_scene(text(model,
                           "[effects.ring]\nkeyframes = [[0, 0.045, 0.002, "
                           "0.003]]\nstiffness_n_per_m = 1e-3\ndamping_n_s_per_m = " +
                               damping + "\n"),
                      "s.toml"),
          2e-6, 5e-4);
    }
  }
}

TEST(SupportGradient, OfRigidSupportsIsRefusedWithARemedyThatHelps) {
  const auto checked = [](const std::string& support) {
    return refusal(
        [&] { check_gradient(parse_scene(text("super_helix", support), "s.toml")); });
  };
  const std::string rigid = "[[supports]]\nat = \"tip\"\nkind = \"ball\"\n";
  EXPECT_NE(checked(rigid).find("give [supports] stiffness_n_per_m"), std::string::npos)
      << checked(rigid);
  EXPECT_EQ(checked(rigid + "stiffness_n_per_m = 0.1\n"), "");
}

}  // namespace tress::test_support_gradient
