#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/gradient/scene_gradient.h"
#include "tests/support/refusal.h"

/// Gradients of runs with exact rigid contact.
namespace tress::test_contact_gradient {

using namespace simulation;
using testing_support::refusal;

std::string head(double duration, int frames, int steps,
                 const std::string& method = "backward_euler") {
  return "title = \"t\"\nduration_s = " + std::to_string(duration) +
         "\nframes_per_s = " + std::to_string(frames / duration) +
         "\n[integrator]\nid = \"" + method +
         "\"\nnewton_tolerance = 1e-13\n"
         "contact_tolerance_m_s = 1e-11\ndt_s = " +
         std::to_string(duration / steps) + "\n[effects.gravity]\n";
}

std::string exact_body(double friction) {
  return "[effects.body]\nfriction_law = \"exact\"\nnormal = \"rigid\"\nfriction = " +
         std::to_string(friction) + "\n";
}

/// Of the coordinates of all points at all frames, from central differences of order 4 of
/// the scene's own runs; over the largest derivative.
double off_by(const Scene& scene, const SceneParameter& parameter,
              const std::vector<std::vector<double>>& by, double e) {
  const auto at = [&](double s) {
    Scene changed = scene;
    parameter.change(changed, s);
    return scene_gradient(changed).strands.front().points;
  };
  const auto p1 = at(e), m1 = at(-e), p2 = at(2 * e), m2 = at(-2 * e);
  double most = 0, apart = 0;
  for (std::size_t f = 0; f < by.size(); ++f) {
    for (std::size_t i = 0; i < by[f].size(); ++i) {
      const double by_runs = (8 * (p1[f][i] - m1[f][i]) - (p2[f][i] - m2[f][i])) /
                             (12 * e * parameter.measure);
      most = std::max(most, std::abs(by_runs));
      const double here = std::abs(by_runs - by[f][i]);
      if (!(here <= apart)) apart = here;  // NaN, too
    }
  }
  EXPECT_GT(most, 0) << parameter.name;
  return apart / most;
}

// The run is smooth where no contact changes its case. Differences at e see Newton's
// tolerance, some 1e-13 L over e of derivatives of 0.1 L and more: 1e-8 at 1e-5. A
// contact that changes its case within e makes them wrong, at 3e-7 less often.
double off(const Scene& scene, double bound) {
  const SceneGradient found = scene_gradient(scene);
  const StrandGradient& strand = found.strands.front();
  EXPECT_EQ(strand.unfinished, "");
  double worst = 0;
  for (std::size_t k = 0; k < found.parameters.size(); ++k) {
    const SceneParameter& parameter = found.parameters[k];
    double apart = off_by(scene, parameter, strand.by[k], 1e-5);
    if (!(apart < bound)) apart = off_by(scene, parameter, strand.by[k], 3e-7);
    testing::Test::RecordProperty(parameter.name,
                                  (testing::Message() << apart).GetString());
    if (!(apart <= worst)) worst = apart;
  }
  return worst;
}

struct Fall {
  const char *model, *body;
  double friction;
};

Scene fall(const Fall& which) {
  const std::string by =
      which.friction > 0 ? ", \"body.friction\", \"root_angle_rad.y\"" : "";
  return parse_scene(
      head(0.12, 3, 60) + exact_body(which.friction) + which.body + "[model]\nid = \"" +
          which.model +
          "\"\n[strand]\nelements = 5\n[root]\n[effects.linear_drag]\ndrag_kg_m_s = "
          "5e-5\n[gradient]\nby = [\"youngs_modulus_pa\", \"linear_drag.drag_kg_m_s\", "
          "\"natural_curvature_per_m\"" +
          by + "]\n",
      "fall.toml");
}

constexpr const char* plane = "centre_m = [0, 0, -0.03]\n";
constexpr const char* sphere =
    "shape = \"sphere\"\nradius_m = 0.05\ncentre_m = [0.06, 0, -0.065]\n";

class GradientOfAFall : public testing::TestWithParam<Fall> {};

TEST_P(GradientOfAFall, IsThatOfDifferencesOfRuns) {
  const double bound = GetParam().friction > 0 ? 1e-4 : 1e-6;
  EXPECT_LT(off(fall(GetParam()), bound), bound);
}

INSTANTIATE_TEST_SUITE_P(Bodies, GradientOfAFall,
                         testing::Values(Fall{"super_helix", plane, 0},
                                         Fall{"super_helix", plane, 0.3},
                                         Fall{"der", plane, 0}, Fall{"der", plane, 0.3},
                                         Fall{"super_helix", sphere, 0},
                                         Fall{"super_helix", sphere, 0.3},
                                         Fall{"der", sphere, 0.3}));

// A level edge, dropped from the height h, rebounds at t1 = sqrt(2 h/g). Until it
// rebounds again, at t2 = t1 + 2 e v1/g, y = e v1 (t - t1) - g (t - t1)^2/2: dy/dh = (1 +
// e) (g/v1) (t - t1) - e. Then y = e^2 v1 (t - t2) - g (t - t2)^2/2 with dt2/dh = (1 + 2
// e)/v1: dy/dh = (1 + e)^2 (g/v1) (t - t2) - e^2 (1 + 2 e).
class GradientOfARebound : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(GradientOfARebound, HasTheMotionsOfTheTimeOfImpact) {
  const auto [restitution, end] = GetParam();
  constexpr double height = 1, g = 9.81;
  const double e = restitution, v1 = std::sqrt(2 * g * height), t1 = v1 / g,
               t2 = t1 + 2 * e * v1 / g;
  // Errors of both impacts add up.
  const int steps = end < t2 ? 400 : 6400;
  const Scene scene = parse_scene(
      head(end, 1, steps) + exact_body(0) +
          "strand_radius_m = 0\nrestitution = " + std::to_string(restitution) +
          "\n[model]\nid = \"der\"\n[strand]\nelements = 1\nposition_m = [0, 0, 1]\n"
          "[root]\nmotion = \"free\"\n[gradient]\nby = [\"root_position_m.z\"]\n",
      "ball.toml");
  const StrandGradient found = scene_gradient(scene).strands.front();
  ASSERT_EQ(found.unfinished, "");
  const double once = (1 + e) * (g / v1) * (end - t1) - e,
               twice = (1 + e) * (1 + e) * (g / v1) * (end - t2) - e * e * (1 + 2 * e);
  const double expected = e == 0 ? 0 : end < t2 ? once : twice;
  EXPECT_NEAR(found.by[0].back()[2], expected, 0.02 * std::max(std::abs(expected), 0.1));
}

INSTANTIATE_TEST_SUITE_P(Heights, GradientOfARebound,
                         testing::Values(std::pair{1.0, 0.5}, std::pair{1.0, 0.8},
                                         std::pair{0.5, 0.5}, std::pair{0.5, 0.8},
                                         std::pair{1.0, 1.6}, std::pair{0.5, 1.1},
                                         std::pair{0.0, 0.5}, std::pair{0.0, 0.8}));

// A rod slides down a slope of angle tan = 0.1 and stops after x = v0^2/(2 g (mu cos -
// sin)): dx/dmu = -x cos/(mu cos - sin), dx/dv0 = 2 x/v0.
TEST(GradientOfASlide, IsThatOfTheStoppingDistance) {
  const double mu = 0.4, angle = std::atan(0.1), v0 = 0.5, g = 9.81;
  const double net = mu * std::cos(angle) - std::sin(angle);
  const double x = v0 * v0 / (2 * g * net);
  const auto text = [](double value) { return std::to_string(value); };
  const double c = std::cos(angle), s = std::sin(angle);
  // Turned by -angle about y, x points uphill at s, so that downhill is -x.
  const Scene scene = parse_scene(
      head(0.3, 1, 800) + exact_body(mu) + "strand_radius_m = 0\nrotation_rad = [0, " +
          text(-angle) +
          ", 0]\n[model]\nid = \"der\"\n[strand]\nelements = 1\nroot_tangent = [" +
          text(-c) + ", 0, " + text(-s) +
          "]\nlength_m = 0.01\nposition_m = [0, 0, 0]\n[root]\nmotion = "
          "\"free\"\nvelocity_m_s = [" +
          text(-v0 * c) + ", 0, " + text(-v0 * s) +
          "]\n[gradient]\nby = [\"body.friction\"]\n",
      "slide.toml");
  const StrandGradient found = scene_gradient(scene).strands.front();
  ASSERT_EQ(found.unfinished, "");
  const auto along = [&](const std::vector<double>& p) { return -c * p[0] - s * p[2]; };
  EXPECT_NEAR(along(found.points.back()) - along(found.points.front()), x, 0.01 * x);
  const double expected = -x * c / net;
  EXPECT_NEAR(along(found.by[0].back()), expected, 0.02 * std::abs(expected));
}

// With a frame at every step, those at the ends of steps in which a contact changes, and
// one step before these.
TEST(ContactGradient, NamesFramesNextToAChangeOfContact) {
  Scene scene =
      fall({"super_helix", "strand_radius_m = 0\ncentre_m = [0, 0, -0.03]\n", 0.3});
  scene.frame_rate = 1 / scene.options.step;
  const StrandGradient found = scene_gradient(scene).strands.front();
  const std::vector<bool>& near = found.near_contact_change;
  ASSERT_EQ(near.size(), found.points.size());
  EXPECT_FALSE(near.front());  // in the air
  const auto first = std::ranges::find(near, true);
  ASSERT_NE(first, near.end());
  // The frame before the impact, and that at its end: the lowest point is on the plane.
  const auto f = static_cast<std::size_t>(first - near.begin());
  const auto lowest = [&](std::size_t frame) {
    double least = 1;
    for (std::size_t i = 2; i < found.points[frame].size(); i += 3) {
      least = std::min(least, found.points[frame][i]);
    }
    return least + 0.03;
  };
  constexpr double tolerance = 1e-9;  // m, of contacts over a step: 2e-14
  EXPECT_GT(lowest(f), tolerance);
  EXPECT_TRUE(near[f + 1]);
  EXPECT_LT(lowest(f + 1), tolerance);  // the tip may reach beyond points with contact
}

TEST(ContactGradient, IsRefusedWhereThereIsNone) {
  const auto checked = [](const std::string& from, const std::string& to) {
    std::string text = head(0.12, 3, 60) + exact_body(0.3) + plane +
                       "[model]\nid = \"super_helix\"\n[strand]\nelements = 5\n[root]\n"
                       "[gradient]\nby = [\"youngs_modulus_pa\"]\n";
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    return refusal([&] { check_gradient(parse_scene(text, "s.toml")); });
  };
  EXPECT_EQ(checked("", ""), "");
  EXPECT_NE(checked("by = ", "way = \"adjoint\"\nby = ").find("computed forward"),
            std::string::npos);
  for (const char* changes : {"bdf2", "tr_bdf2", "esdirk43"}) {
    EXPECT_NE(checked("backward_euler", changes).find("use backward_euler"),
              std::string::npos);
  }
  EXPECT_NE(checked("\"rigid\"", "\"compliant\"").find("use normal = \"rigid\""),
            std::string::npos);
  EXPECT_NE(checked("-0.03", "0.01").find("begins inside a body"), std::string::npos);
}

// The sphere reaches into the strand between two nodes, and no node is inside. Contact
// acts on the points of the quadrature.
TEST(ContactGradient, IsRefusedWhereAStrandBeginsInsideBetweenItsNodes) {
  const auto inside = [](const std::string& radius) {
    return refusal([&] {
      check_gradient(parse_scene(
          head(0.12, 3, 60) +
              "[effects.body]\nshape = \"sphere\"\ncentre_m = [0.046176, 0, "
              "-0.061438]\nfriction_law = \"exact\"\nnormal = \"rigid\"\nradius_m = " +
              radius +
              "\n[model]\nid = \"super_helix\"\n[strand]\nlength_m = 0.1\nelements = "
              "4\nshape = \"along\"\ndarboux_along = [[0, 0, 10, 0]]\n[root]\n"
              "[gradient]\nby = [\"body.radius_m\"]\n",
          "s.toml"));
    });
  };
  EXPECT_NE(inside("0.04").find("begins inside a body"), std::string::npos);
  EXPECT_EQ(inside("0.03"), "");
}

}  // namespace tress::test_contact_gradient
