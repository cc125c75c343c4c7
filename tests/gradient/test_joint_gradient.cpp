#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "simulation/fit/scene_fit.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/run/world.h"
#include "tests/support/apart.h"
#include "tests/support/refusal.h"

namespace tress::test_joint_gradient {

using namespace simulation;
using testing_support::refusal;

/// A clamped strand that swings, and one with a free root at its tip.
std::string text(const std::string& model, const std::string& method,
                 const std::string& joint, const std::string& by) {
  return "title = \"t\"\nduration_s = 0.06\nframes_per_s = 50\n[model]\nid = \"" + model +
         "\"\n[integrator]\nid = \"" + method +
         "\"\ndt_s = 0.002\nnewton_tolerance = 1e-12\n" +
         (joint.find("spring") == joint.npos ? "formulation = \"index3\"\n" : "") +
         "[material]\ninternal_friction_kg_m3_s = 1e-10\n"
         "[[strand]]\nname = \"upper\"\nlength_m = 0.05\nelements = 3\n"
         "[[strand]]\nname = \"lower\"\nlength_m = 0.04\nelements = 2\nroot = \"free\"\n"
         "shape = \"helix\"\ncurl_radius_m = 0.01\ncurl_pitch_m = 0.03\n"
         "position_m = " +
         (joint.find("rest_length") == joint.npos ? "[0.05, 0, 0]\n"
                                                  : "[0.051, 0, 0]\n") +
         "[root]\nmotion = \"shake\"\namplitude_m = 0.01\nfrequency_hz = 4\n" +
         "[[joints]]\na = [\"upper\", \"tip\"]\nb = [\"lower\", \"root\"]\n" + joint +
         "[effects.gravity]\ngravity_m_s2 = [0.5, 0.2, -9.81]\n"
         "[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n[gradient]\nof = \"points\"\n"
         "start = \"as_run\"\nby = [" +
         by + "]\n";
}

const std::string ball = "kind = \"ball\"\n", weld = "kind = \"weld\"\n",
                  spring =
                      "kind = \"spring\"\nstiffness_n_per_m = 0.1\n"
                      "damping_n_s_per_m = 1e-5\n",
                  slack = spring + "rest_length_m = 0.0012\n";
const std::string numbers =
    "\"youngs_modulus_pa\", \"density_kg_m3\", \"internal_friction_kg_m3_s\", "
    "\"linear_drag.drag_kg_m_s\", \"natural_curvature_per_m\", \"root_position_m.z\", "
    "\"root.amplitude_m\"";

struct Case {
  const char *name, *model, *method;
  const std::string& joint;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }  // NOLINT

class JointGradient : public testing::TestWithParam<Case> {
 protected:
  static Scene scene(const std::string& way = "forward") {
    const Case& c = GetParam();
    return parse_scene(
        text(c.model, c.method, c.joint, numbers) + "way = \"" + way + "\"\n", "s.toml");
  }
};

/// The points of both strands at the end, one after the other, of the runs that are
/// differentiated.
std::vector<double> last_points(const Scene& scene) {
  const GradientTask task{.parameters = {}, .times = times_of_frames(scene)};
  std::vector<double> all;
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    const StrandGradient run = strand_gradient(scene, k, task);
    EXPECT_EQ(run.unfinished, "");
    all.insert(all.end(), run.points.back().begin(), run.points.back().end());
  }
  return all;
}

// Differences see Newton's tolerance, 1e-12 of the typical sizes in each of 30 steps,
// over 1e-4 of the values, of which a tenth and more reaches the points: 3e-6.
TEST_P(JointGradient, IsThatOfDifferencesOfRuns) {
  const Scene joined = scene();
  check_gradient(joined);
  const SceneGradient found = scene_gradient(joined);
  ASSERT_EQ(found.strands.size(), 2u);
  std::vector<double> points;
  for (const StrandGradient& strand : found.strands) {
    ASSERT_EQ(strand.unfinished, "");
    points.insert(points.end(), strand.points.back().begin(), strand.points.back().end());
  }
  World world(joined, 1);
  ASSERT_EQ(world.advance(joined.duration), Status::ok);
  // World is the run; it solves with the same tolerance.
  EXPECT_LT(apart(world.positions(), points), 1e-9);
  for (std::size_t k = 0; k < found.parameters.size(); ++k) {
    const SceneParameter& by = found.parameters[k];
    constexpr double e = 1e-4;
    const auto at = [&](double s) {
      Scene changed = joined;
      by.change(changed, s);
      return last_points(changed);
    };
    std::vector<double> own;
    for (const StrandGradient& strand : found.strands) {
      own.insert(own.end(), strand.by[k].back().begin(), strand.by[k].back().end());
    }
    const auto p1 = at(e), m1 = at(-e), p2 = at(2 * e), m2 = at(-2 * e);
    double worst = 0, most = 0;
    for (std::size_t i = 0; i < p1.size(); ++i) {
      const double d = (8 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12 * e * by.measure);
      worst = std::max(worst, std::abs(own[i] - d));
      most = std::max(most, std::abs(d));
    }
    EXPECT_GT(most * by.measure, 1e-7) << by.name;
    EXPECT_LT(worst, 1e-5 * most) << by.name;
  }
}

// Rounding, and the differences of residuals in both.
TEST_P(JointGradient, BackwardIsThatForward) {
  const SceneGradient forward = scene_gradient(scene()),
                      adjoint = scene_gradient(scene("adjoint"));
  for (std::size_t strand = 0; strand < 2; ++strand) {
    const auto &x = forward.strands[strand].by, &y = adjoint.strands[strand].by;
    ASSERT_EQ(adjoint.strands[strand].unfinished, "");
    ASSERT_TRUE(adjoint.strands[strand].adjoint);
    for (std::size_t k = 0; k < x.size(); ++k) {
      double worst = 0, most = 0;
      for (std::size_t f = 0; f < x[k].size(); ++f) {
        for (std::size_t i = 0; i < x[k][f].size(); ++i) {
          worst = std::max(worst, std::abs(x[k][f][i] - y[k][f][i]));
          most = std::max(most, std::abs(x[k][f][i]));
        }
      }
      EXPECT_LT(worst, 1e-6 * most) << strand << ", " << forward.parameters[k].name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Joints, JointGradient,
    testing::Values(Case{"HelixBall", "super_helix", "backward_euler", ball},
                    Case{"HelixWeld", "super_helix", "bdf2", weld},
                    Case{"HelixSpring", "super_helix", "tr_bdf2", spring},
                    Case{"HelixSlack", "super_helix", "backward_euler", slack},
                    Case{"DerBall", "der", "backward_euler", ball},
                    Case{"DerWeld", "der", "bdf2", weld},
                    Case{"DerSpring", "der", "esdirk43", spring},
                    Case{"DerSlack", "der", "backward_euler", slack}),
    [](const auto& c) { return c.param.name; });

TEST(JointGradientChecks, AMethodThatStartsFromAccelerationsIsRefused) {
  const std::string answer = refusal([] {
    check_gradient(
        parse_scene(text("der", "tr_bdf2", weld, "\"youngs_modulus_pa\""), "s.toml"));
  });
  EXPECT_NE(answer.find("joined strands"), std::string::npos) << answer;
  EXPECT_NE(answer.find("use backward_euler, bdf2"), std::string::npos) << answer;
}

/// The tips of both strands at the frames.
PointRecord record_of(const Scene& scene) {
  const GradientTask task{.parameters = {}, .times = times_of_frames(scene)};
  PointRecord record{.file = "r.csv", .hash = "r"};
  for (std::size_t strand = 0; strand < scene.strands.size(); ++strand) {
    const StrandGradient run = strand_gradient(scene, strand, task);
    for (std::size_t f = 1; f < task.times.size(); ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        Observation& one = record.observations.emplace_back();
        one.strand = strand;
        one.t = task.times[f];
        one.component = c;
        one.value = run.points[f].end()[static_cast<std::ptrdiff_t>(c) - 3];
      }
    }
  }
  record.places.resize(1);
  return record;
}

// A Gauss-Newton step below the tolerance of the search, 1e-5, leaves its square.
TEST(JointFit, FindsTheModulusOfJoinedStrands) {
  const auto scene = [](const char* modulus) {
    std::string of = text("der", "bdf2", weld, "\"youngs_modulus_pa\"");
    of.replace(of.find("internal_friction"), 0,
               std::string("youngs_modulus_pa = ") + modulus + "\n");
    return parse_scene(of, "s.toml");
  };
  const PointRecord record = record_of(scene("3e9"));
  const Scene start = scene("4e9");
  const SceneFit fit =
      fit_scenes({.records = {{&start, &record}}, .by = {"youngs_modulus_pa"}});
  EXPECT_NEAR(fit.parameters.at(0).value / 3e9, 1, 1e-6) << fit.reason;
  EXPECT_FALSE(std::isnan(fit.parameters[0].step_shift));
  EXPECT_FALSE(std::isnan(fit.parameters[0].elements_shift)) << fit.reason;
}

// Turned about its own root, each strand leaves the point of the other.
TEST(JointGradientChecks, AParameterThatPartsAJointIsRefused) {
  const Scene scene = parse_scene(
      text("super_helix", "backward_euler", ball, "\"root_angle_rad.y\""), "s.toml");
  EXPECT_NE(refusal([&] { scene_gradient(scene); })
                .find("no gradient by root_angle_rad.y: it takes the strand off its "
                      "joints or rigid supports at the start (s.toml:"),
            std::string::npos);
}

TEST(JointGradientChecks, AFormulationWithoutDerivativesIsRefused) {
  std::string wrong = text("der", "bdf2", ball, "\"youngs_modulus_pa\"");
  wrong.replace(wrong.find("index3"), 6, "projection");
  const std::string answer =
      refusal([&] { check_gradient(parse_scene(wrong, "s.toml")); });
  EXPECT_NE(answer.find("use formulation = \"index3\""), std::string::npos) << answer;
}

}  // namespace tress::test_joint_gradient
