#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/catalogue.h"
#include "simulation/gradient/scene_gradient.h"
#include "tests/support/refusal.h"

namespace tress::test_place_gradient {

using namespace simulation;
using testing_support::refusal;

/// Of a scene with backward_euler; `more` begins in [integrator].
std::string scene_text(std::string_view model, const std::string& times,
                       const std::string& more) {
  return "title = \"t\"\n" + times + "[model]\nid = \"" + std::string(model) +
         "\"\n[integrator]\nid = \"backward_euler\"\nnewton_tolerance = 1e-12\n" + more;
}

/// A straight hair, let go along x; its text ends in [strand].
constexpr const char* hair =
    "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = 5e-5\n[material]\nname = "
    "\"custom\"\nradius_m = 5e-5\nellipticity = 1.0\nyoungs_modulus_pa = "
    "3e9\nshear_modulus_pa = 1e9\ndensity_kg_m3 = 1300.0\ninternal_friction_kg_m3_s = "
    "1e-10\n[strand]\nlength_m = 0.1\nroot_tangent = [1, 0, 0]\nnormal = [0, 1, 0]\n";

StrandGradient gradient(const std::string& text) {
  const Scene scene = parse_scene(text, "s.toml");
  StrandGradient found = scene_gradient(scene).strands.front();
  EXPECT_EQ(found.unfinished, "");
  EXPECT_EQ(found.points.size(), scene.last_frame() + 1);
  return found;
}

/// Largest |sum over parameters of d tip - expected| at any frame.
double away_from(const StrandGradient& found, const std::vector<double>& expected) {
  double most = 0;
  for (std::size_t f = 0; f < found.points.size(); ++f) {
    const std::size_t tip = found.points[f].size() - 3;
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = -expected[i];
      for (const auto& by : found.by) sum += by[f][tip + i];
      most = std::max(most, std::abs(sum));
    }
  }
  return most;
}

/// What acts on the hair, and the lines of [gradient].
struct Acting {
  const char *name, *effects, *by;
};
constexpr Acting all_acting[] = {
    {"plane",
     "[effects.body]\nshape = \"plane\"\ncentre_m = [0, 0, -0.004]\nfriction = 0\n",
     "\"body.centre_m.z\""},
    {"sphere",
     "[effects.body]\nshape = \"sphere\"\nradius_m = 0.05\ncentre_m = [0.06, 0.01, "
     "-0.055]\nfriction = 0\n",
     "\"body.centre_m.z\""},
    {"tether in wind",
     "[effects.wind]\nvelocity_m_s = [0.5, 0, 0.2]\n[effects.tether]\nat = 1.0\npull_n = "
     "2e-5\nsoft_m = 0.02\ntarget_m = [0.05, 0.03, 0]\nt_on_s = 0.02\nt_off_s = "
     "0.06\nramp_s = 0.01\n",
     "\"tether.target_m.z\""},
};

// Moving the root and all else that has a place moves the run with them. Differences of
// positions, rounded at 1e-17 m, over 2e-10 m are within 1e-7, which the 50 steps of a
// damped motion add up at most.
TEST(PlaceGradient, OfRootAndSurroundingsTogetherIsAShift) {
  int runs = 0;
  for (const models::ModelEntry& model : models::model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    for (const Acting& acting : all_acting) {
      const auto with = [&](const std::string& formulation) {
        return scene_text(model.id, "duration_s = 0.1\nframes_per_s = 50\n",
                          formulation + "dt_s = 0.002\n" + hair + "elements = 4\n" +
                              acting.effects + "[gradient]\nstart = \"as_run\"\nby = [" +
                              "\"root_position_m.z\", " + acting.by + "]\n");
      };
      std::string text = with("");
      const auto refused = [&] {
        return refusal([&] { check_gradient(parse_scene(text, "s.toml")); });
      };
      if (refused().ends_with("use formulation = \"index3\"")) {
        text = with("formulation = \"index3\"\n");
      }
      if (!refused().empty()) continue;
      ++runs;
      SCOPED_TRACE(std::string(model.id) + ", " + acting.name);
      const StrandGradient found = gradient(text);
      EXPECT_LT(away_from(found, {0, 0, 1}), 1e-6);
      // The effect acts, by much more than the bar.
      EXPECT_GT(std::abs(found.by[1].back().back()), 1e-2);
    }
  }
  EXPECT_GE(runs, 3 * 10);
}

std::string falls_on_sphere(const std::string& model, double duration,
                            const std::string& by) {
  return scene_text(
      model, "duration_s = " + std::to_string(duration) + "\nframes_per_s = 20\n",
      std::string("dt_s = 0.001\n") + hair +
          "elements = 8\nposition_m = [0, 0, 0.03]\n[effects.body]\nshape = "
          "\"sphere\"\nradius_m = 0.05\ncentre_m = [0.03, 0, -0.03]\nfriction = "
          "0.3\nstrand_radius_m = 5e-5\n[gradient]\nstart = \"as_run\"\nby = [" +
          by + "]\n");
}

// A sphere at rest and its offset enter the law by their sum alone. The distances of both
// differences, 2e-10 and 1.5e-10 m, see positions rounded at 1e-17 m: 1e-7 of the load.
// The motion of 300 steps with contact multiplies that by less than 100.
TEST(PlaceGradient, ByTheRadiusOfASphereIsThatByTheOffset) {
  const StrandGradient found = gradient(
      falls_on_sphere("der", 0.3, "\"body.radius_m\", \"body.strand_radius_m\""));
  double apart = 0, most = 0;
  for (std::size_t f = 0; f < found.points.size(); ++f) {
    for (std::size_t i = found.points[f].size() - 3; i < found.points[f].size(); ++i) {
      apart = std::max(apart, std::abs(found.by[0][f][i] - found.by[1][f][i]));
      most = std::max(most, std::abs(found.by[1][f][i]));
    }
  }
  EXPECT_GT(most, 1);
  EXPECT_LT(apart, 1e-5 * most);
}

// Central differences of runs whose root is 1e-6 m higher and lower, with Newton's
// tolerance at 1e-12: (-0.3657, 0, -0.0125). Regularised friction limits the forward
// derivatives of reduced models to some 1e-4 (docs/theory/gradients.md, Limits).
TEST(PlaceGradient, OfAHairOnAPlaneIsThatOfDifferences) {
  const std::string plane =
      std::string("dt_s = 0.001\n") + hair +
      "elements = 8\nposition_m = [0, 0, 0.03]\n[effects.body]\nshape = "
      "\"plane\"\ncentre_m = [0, 0, 0]\nfriction = 0.3\nstrand_radius_m = "
      "5e-5\n[gradient]\nstart = \"as_run\"\nby = [\"root_position_m.z\", "
      "\"body.centre_m.z\"]\n";
  const StrandGradient found =
      gradient(scene_text("super_helix", "duration_s = 0.3\nframes_per_s = 10\n", plane));
  const std::vector<double>& last = found.by[0].back();
  EXPECT_NEAR(last.end()[-3], -0.3657, 1e-3);
  EXPECT_NEAR(last.end()[-2], 0, 1e-6);
  EXPECT_NEAR(last.end()[-1], -0.0125, 1e-3);
  EXPECT_LT(away_from(found, {0, 0, 1}), 1e-3);
}

/// A curl that rubs on a plane, by forward derivatives or the adjoint.
StrandGradient rubbing(const std::string& model, const std::string& way) {
  return gradient(
      scene_text(model, "duration_s = 0.1\nframes_per_s = 20\n", "dt_s = 0.0025\n") +
      "[material]\ninternal_friction_kg_m3_s = 1e-10\n[strand]\nlength_m = "
      "0.1\nelements = 5\nshape = \"helix\"\n[root]\nmotion = \"shake\"\namplitude_m = "
      "0.005\nfrequency_hz = 4\n[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s "
      "= 1e-4\n[effects.body]\ncentre_m = [0, 0, -0.022]\n[gradient]\nof = "
      "\"last_tip\"\nway = \"" +
      way +
      "\"\nby = [\"youngs_modulus_pa\", \"internal_friction_kg_m3_s\", "
      "\"natural_curvature_per_m\", \"initial_curvature_per_m\", "
      "\"linear_drag.drag_kg_m_s\", \"root.frequency_hz\", \"body.stiffness_n_m2\", "
      "\"body.friction\", \"root_angle_rad.x\", \"gravity.gravity_m_s2.z\"]\n");
}

// The adjoint has the derivatives of friction in its matrices. Differences of order 2 of
// a residual at 1e-5 of the typical rates were 1e-4 off: friction turns within 1e-3 of
// them. Those of order 4 are (1e-2)^4 off.
TEST(FrictionGradient, ForwardIsThatOfTheAdjoint) {
  for (const std::string model : {"super_helix", "super_clothoid", "articulated_chain"}) {
    const StrandGradient forward = rubbing(model, "forward"),
                         adjoint = rubbing(model, "adjoint");
    ASSERT_EQ(forward.by.size(), adjoint.by.size());
    for (std::size_t k = 0; k < forward.by.size(); ++k) {
      SCOPED_TRACE(model + ", parameter " + std::to_string(k));
      double worst = 0, most = 0;
      for (std::size_t c = 1; c <= 3; ++c) {
        const double expected = *(adjoint.by[k].back().end() - c);
        worst = std::max(worst, std::abs(*(forward.by[k].back().end() - c) - expected));
        most = std::max(most, std::abs(expected));
      }
      EXPECT_LT(worst, 1e-6 * most);
    }
  }
}

}  // namespace tress::test_place_gradient
