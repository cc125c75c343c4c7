#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contract/parameters.h"
#include "integrators/gradient/step_memory.h"
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
    const GradientTask task{.parameters = {}, .times = times_of_frames(one)};
    const StrandGradient run = strand_gradient(one, 0, task);
    EXPECT_EQ(run.unfinished, "");
    return run.points.back();
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

/// The same scene by another method, with these parameters besides.
std::string with(std::string scene, const std::string& method, const std::string& by) {
  const auto replace = [&scene](const std::string& old, const std::string& now) {
    scene.replace(scene.find(old), old.size(), now);
  };
  replace("id = \"tr_bdf2\"", "id = \"" + method + "\"");
  if (!by.empty()) replace("\"natural_curvature_per_m\"]", by + "]");
  return scene;
}

/// The same scene with these keys of [integrator]. Newton's method does not reach 1e-13
/// in every stage with constraints or moments.
std::string with_steps(std::string scene, const std::string& keys) {
  const std::string old = "newton_tolerance = 1e-13\n";
  return scene.replace(scene.find(old), old.size(), keys);
}

/// Adjoint against forward, at all points and frames, within this part of the largest.
void expect_adjoint(const std::string& scene, double bar = 1e-7) {
  const auto by = [&scene](const std::string& way) {
    const auto found = scene_gradient(
        parse_scene(scene + "of = \"points\"\nway = \"" + way + "\"\n", "s.toml"));
    EXPECT_EQ(found.strands.front().unfinished, "");
    return found.strands.front().by;
  };
  const auto forward = by("forward"), adjoint = by("adjoint");
  ASSERT_EQ(forward.size(), adjoint.size());
  for (std::size_t k = 0; k < forward.size(); ++k) {
    ASSERT_EQ(forward[k].size(), adjoint[k].size());
    double worst = 0, most = 0;
    for (std::size_t f = 0; f < forward[k].size(); ++f) {
      for (std::size_t i = 0; i < forward[k][f].size(); ++i) {
        worst = std::max(worst, std::abs(adjoint[k][f][i] - forward[k][f][i]));
        most = std::max(most, std::abs(forward[k][f][i]));
      }
    }
    EXPECT_LT(worst, bar * most) << k;
  }
}

const std::string moments =
    "[[effects.point_moment]]\nat = 1\nmoment_n_m = [0, 2e-9, 1e-9]\n"
    "factor_over_time = [[0, 1], [0.05, 0.5]]\n"
    "[[effects.point_moment]]\nat = 1\nfollower_n_m = [2e-10, 1e-9, 0]\n";
const std::string shapes =
    "[[effects.natural_shape]]\nfrom = 0.5\ncurvature_per_m = [[0, 0], [0.06, 30]]\n";

// Differences see Newton's tolerance, 1e-12 of the typical sizes in each of 60 steps,
// over 1e-3 of the values, of which a tenth and more reaches the points: 6e-7.
TEST(DrivenGradient, OfMomentsAndNaturalShapesIsThatOfDifferencesOfRuns) {
  for (const std::string model : {"super_helix", "der"}) {
    SCOPED_TRACE(model);
    const std::string scene = with_steps(
        with(text(model, moments + shapes), "tr_bdf2",
             "\"natural_curvature_per_m\", \"point_moment.moment_n_m.y\", "
             "\"point_moment.moment_n_m.z\", \"point_moment_2.follower_n_m.x\""),
        "newton_tolerance = 1e-12\n");
    expect_differences(parse_scene(scene, "s.toml"), 1e-3, 1e-6);
    expect_adjoint(scene);
  }
}

TEST(SupportGradient, ByNumbersOfSupportsIsThatOfDifferencesOfRuns) {
  const std::string supports =
      "[[supports]]\nat = 0.5\nkind = \"ball\"\nstiffness_n_per_m = 1e-4\n"
      "[[supports]]\nat = \"tip\"\nkind = \"clamp\"\nstiffness_n_per_m = "
      "0.01\ndamping_n_s_per_m = 1e-5\nturn_stiffness_n_m_per_rad = 1e-8\n";
  for (const std::string model : {"super_helix", "der", "articulated_chain"}) {
    SCOPED_TRACE(model);
    const std::string scene =
        with(text(model, supports), "tr_bdf2",
             "\"supports.stiffness_n_per_m\", \"supports_2.damping_n_s_per_m\", "
             "\"supports_2.turn_stiffness_n_m_per_rad\"");
    expect_differences(parse_scene(scene, "s.toml"), 1e-3, 1e-6);
    expect_adjoint(scene);
  }
}

/// A sphere below the strand that moves and turns.
const std::string moving_body =
    "[effects.body]\nshape = \"sphere\"\nradius_m = 0.005\ncentre_m = [0.05, 0, "
    "-0.2]\nmoves = \"keyframes\"\naxis = [0, 1, 0.2]\nkeyframes = [[0, 0, 0, 0, 0], "
    "[0.1, 0, 0.002, 0.003, 0.05]]\n";

// What carries a support moves it, and turns it about its centre.
TEST(SupportGradient, OfSupportsOnWhatMovesIsThatOfDifferencesOfRuns) {
  const std::string yields = "stiffness_n_per_m = 0.01\ndamping_n_s_per_m = 1e-5\n";
  const auto on = [](const std::string& carrier) {
    return "[[supports]]\nat = \"tip\"\nkind = \"ball\"\non = \"" + carrier + "\"\n";
  };
  for (const std::string model : {"super_helix", "der"}) {
    for (const bool rigid : {false, true}) {
      SCOPED_TRACE(model + (rigid ? ", rigid" : ", compliant"));
      const std::string method = rigid ? "bdf2" : "tr_bdf2";
      const std::string keys = std::string("newton_tolerance = 1e-12\n") +
                               (rigid ? "formulation = \"index3\"\n" : "");
      const std::string more = rigid ? "" : yields;
      const auto scene = [&](const std::string& support, const std::string& by) {
        return parse_scene(with_steps(with(text(model, support), method, by), keys),
                           "s.toml");
      };
      expect_differences(scene(on("body") + more + moving_body, "\"body.centre_m.x\""),
                         1e-3, 1e-6);
      expect_differences(scene(on("head") + more, "\"root.amplitude_m\""), 1e-3, 1e-6);
    }
  }
}

/// A strand held at its tip, and at its middle in one direction.
const std::string rigid =
    "[[supports]]\nat = \"tip\"\nkind = \"ball\"\n"
    "[[supports]]\nat = 0.5\nkind = \"ball\"\nslide = [1, 0, 0]\n";

class RigidSupportGradientOf : public testing::TestWithParam<std::string> {};

// Supports hold the place where the strand begins, which moves with the root. They are
// constraints of index 3.
TEST_P(RigidSupportGradientOf, IsThatOfDifferencesOfRuns) {
  // From accelerations that a held place has at once, Newton's method finds no first
  // step.
  const bool starts = integrators::starts_from_accelerations(GetParam());
  const std::string direction = "[[supports]]\nat = \"tip\"\nkind = \"direction\"\n";
  for (const std::string model : {"super_helix", "der"}) {
    SCOPED_TRACE(model);
    const std::string scene =
        with_steps(with(text(model, starts ? direction : rigid), GetParam(), ""),
                   "newton_tolerance = 1e-12\nformulation = \"index3\"\n");
    if (model == "super_helix" && starts) {
      const std::string no =
          refusal([&] { check_gradient(parse_scene(scene, "s.toml")); });
      EXPECT_NE(no.find("use backward_euler, bdf2"), std::string::npos) << no;
      continue;
    }
    expect_differences(parse_scene(scene, "s.toml"), 1e-3, 1e-6);
    // Columns of differences have 1e-11 of forces, which stretching makes large.
    expect_adjoint(scene, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, RigidSupportGradientOf,
                         testing::Values("backward_euler", "bdf2", "tr_bdf2", "esdirk43"),
                         [](const auto& c) { return c.param; });

std::string refused(const std::string& scene) {
  return refusal([&] {
    const Scene read = parse_scene(scene, "s.toml");
    check_gradient(read);
    scene_gradient(read);
  });
}

TEST(SupportGradient, IsRefusedWithAReasonAndARemedyThatHelps) {
  const auto has = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  std::string projected = text("der", rigid);
  projected.replace(projected.find("dt_s = 0.002\n"), 13,
                    "dt_s = 0.002\nformulation = \"projection\"\n");
  has(refused(projected), "use formulation = \"index3\"");
  const std::string away =
      "[[supports]]\nat = \"tip\"\nkind = \"ball\"\nkeyframes = [[0, 0.02, 0.01, 0]]\n";
  has(refused(text("der", away)), "begins off its supports");
  // Its place is fixed in space.
  const Scene scene = parse_scene(text("der", rigid), "s.toml");
  const std::vector<double> tip = [&] {
    World world(scene, 1);
    return std::vector<double>(world.positions().end() - 3, world.positions().end());
  }();
  const std::string fixed =
      "[[supports]]\nat = \"tip\"\nkind = \"ball\"\nkeyframes = [[0, " +
      number_text(tip[0]) + ", " + number_text(tip[1]) + ", " + number_text(tip[2]) +
      "]]\n";
  has(refused(text("der", fixed)),
      "no gradient by root_position_m.z: it takes the strand off its rigid supports");
}

TEST(DrivenGradient, ByNumbersWithoutADerivativeIsRefused) {
  const auto by = [](const std::string& name) {
    return refused(with(text("super_helix", moments + shapes), "tr_bdf2", name));
  };
  const std::pair<const char*, const char*> cases[] = {
      {"\"point_moment.at\"", "the end of an element"},
      {"\"point_moment_3.moment_n_m.x\"", "unknown parameter"},
      {"\"point_moment.moment_n_m\"", "has the components x, y and z"},
      {"\"natural_shape.from\"", "derivatives jump"},
      {"\"natural_shape.curvature_per_m\"", "it is not a number"}};
  for (const auto& [name, reason] : cases) {
    EXPECT_NE(by(name).find(reason), std::string::npos) << name << ": " << by(name);
  }
}

}  // namespace tress::test_support_gradient
