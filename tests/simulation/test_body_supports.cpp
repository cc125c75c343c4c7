// Strands that end on bodies which they drive, against rigid bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "integrators/catalogue.h"
#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "tests/support/columns.h"
#include "tests/support/refusal.h"

namespace tress::test_body_supports {

using namespace simulation;
using integrators::integrator_catalogue;
using integrators::IntegratorEntry;
using testing_support::refusal;

constexpr double g = 9.81, pi = std::numbers::pi;

/// A thin steel bar of 0.5 m in the plane y = 0 that ends on a body.
struct Text {
  std::string model = "id = \"super_helix\"";
  std::string integrator = "id = \"implicit_midpoint\"\ndt_s = 1e-3";
  double angle = 0;  // of the bar, from the downward vertical
  double begin = 0;  // distance of its root from the origin, m
  std::string body, supports, more;
  int elements = 1;

  static constexpr double length = 0.5, radius = 5e-3, density = 8000;
  static double mass() { return density * pi * radius * radius * length; }
  Vec along(double s) const { return {s * std::sin(angle), 0, -s * std::cos(angle)}; }
  std::string text() const {
    const auto place = [](const Vec& x) {
      return "[" + number_text(x.x) + ", 0, " + number_text(x.z) + "]";
    };
    return "title = \"bar\"\nduration_s = 10\n[model]\n" + model + "\n[integrator]\n" +
           integrator +
           "\n[material]\nname = \"custom\"\nradius_m = 5e-3\ndensity_kg_m3 = "
           "8000\nyoungs_modulus_pa = 1e12\npoisson_ratio = 0.3\n[strand]\nelements = " +
           std::to_string(elements) +
           "\nnatural = \"straight\"\nnormal = [0, 1, 0]\npoints = [" +
           place(along(begin)) + ", " + place(along(begin + length / 2)) + ", " +
           place(along(begin + length)) +
           "]\n[root]\nmotion = \"free\"\n[effects.gravity]\n" + body + supports + more;
  }
};

Scene scene_of(const Text& text) { return parse_scene(text.text(), "bar.toml"); }

/// The angle of a pendulum, theta'' = -square sin theta from rest, by Runge-Kutta's
/// method with steps of 1e-4 s.
double pendulum(double square, double theta, double end) {
  const auto f = [square](double x) { return -square * std::sin(x); };
  double v = 0;
  const int steps = static_cast<int>(std::lround(end / 1e-4));
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) {
    const double v1 = f(theta), v2 = f(theta + h / 2 * v),
                 v3 = f(theta + h / 2 * (v + h / 2 * v1)),
                 v4 = f(theta + h * (v + h / 2 * v2));
    theta += h * (v + h / 6 * (v1 + v2 + v3));
    v += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
  }
  return theta;
}

/// A drum of radius 0.2 m about the y axis, which the bar holds at its circumference.
Text drum(const std::string& more) {
  Text text;
  text.begin = 0.2;
  text.body =
      "[effects.body]\nshape = \"capsule\"\nrotation_rad = [1.5707963267948966, 0, 0]\n"
      "radius_m = 0.19\nlength_m = 0.1\nmoves = \"turns\"\naxis = [0, 1, "
      "0]\ninertia_kg_m2 = 0.02\nstrand_radius_m = 5e-3\n" +
      more;
  text.supports = "[[supports]]\nat = \"root\"\nkind = \"clamp\"\non = \"body\"\n";
  return text;
}

/// A bar lies horizontally on a drum, whose moment M bears its weight. At every instant
/// the drum turns by its moment, by the force f of the bar at the radius r and by the
/// moment m of the bar: I theta'' = M + r f_z - m_y. Forces are read at steps of 1/15 of
/// the period of the bar, 16 ms, so their mean errs by a part of (2 pi/15)^2/12 = 1.5 %
/// of their oscillation, which is as large as the weight.
TEST(ABarOnADrum, PullsWithTheMomentOfItsWeight) {
  const double weight = Text::mass() * g, arm = 0.2 + Text::length / 2;
  Text text = drum("torque_n_m = " + number_text(-weight * arm) + "\n");
  text.angle = pi / 2;
  const Scene scene = scene_of(text);
  World world(scene);
  double moment = 0, force = 0;
  const int steps = 200;
  for (int i = 1; i <= steps; ++i) {
    ASSERT_EQ(world.advance(i * 1e-3), Status::ok) << world.failure();
    const World::SupportLoads loads = world.support_loads();
    ASSERT_EQ(loads.forces.size(), 3U);
    force += loads.forces[2] / steps;
    moment += (0.2 * loads.forces[2] - loads.moments[1]) / steps;
  }
  const double speed = world.body_motions().front().speed;
  // The bar bends by m g L^2/(6 E I) = 3e-4 rad.
  EXPECT_LT(std::abs(world.body_motions().front().angle), 3e-4);
  std::printf("force %.4f of %.4f, moment %.4f of %.4f\n", force, weight, moment,
              weight * arm + 0.02 * speed / 0.2);
  EXPECT_NEAR(force, weight, 0.05 * weight);
  EXPECT_NEAR(moment, weight * arm + 0.02 * speed / 0.2, 0.02 * weight * arm);
}

/// Drum and bar are one rigid body: (I + m (L^2/12 + a^2/4 + d^2)) theta'' = -m g d sin
/// theta, with the place d of the bar's centre. The implicit midpoint rule errs by
/// (omega dt)^2/24 of the phase, 1e-6 here, and the bar bends by 1e-6.
TEST(ABarOnADrum, SwingsAsOneRigidBody) {
  for (const char* model : {"super_helix", "super_clothoid"}) {
    Text text = drum("");
    text.model = std::string("id = \"") + model + "\"";
    text.angle = 0.5;
    const double m = Text::mass(), length = Text::length, d = 0.2 + length / 2;
    const double inertia =
        0.02 + m * (length * length / 12 + Text::radius * Text::radius / 4 + d * d);
    World world(scene_of(text));
    ASSERT_EQ(world.advance(1), Status::ok) << world.failure();
    // The bar's angle falls as the drum turns by the right-hand rule about y.
    const double exact = pendulum(m * g * d / inertia, 0.5, 1);
    std::printf("%s: angle %.8f, rigid %.8f\n", model,
                0.5 - world.body_motions().front().angle, exact);
    EXPECT_NEAR(0.5 - world.body_motions().front().angle, exact, 2e-5) << model;
  }
}

/// A heavy ball of radius 0.05 m at the tip, and a support at the root.
Text bob(const std::string& more = "") {
  Text text;
  text.angle = 0.5;
  const Vec centre = text.along(Text::length + 0.06);
  text.body = "[effects.body]\nshape = \"sphere\"\nradius_m = 0.05\ncentre_m = [" +
              number_text(centre.x) + ", 0, " + number_text(centre.z) +
              "]\nmoves = \"free\"\nmass_kg = 3\nstrand_radius_m = 5e-3\n" + more;
  text.supports =
      "[[supports]]\nat = \"root\"\nkind = \"ball\"\n[[supports]]\nkind = "
      "\"clamp\"\non = \"body\"\n";
  return text;
}

/// The angle of the bob about the origin.
double angle_of(const World& world) {
  const Vec x = world.body_motions().front().x;
  return std::atan2(x.x, -x.z);
}

/// The physical pendulum of a bar and a ball.
double bob_at(double end) {
  const double m = Text::mass(), length = Text::length, d = length + 0.06;
  const double inertia = m * (length * length / 3 + Text::radius * Text::radius / 4) +
                         3 * (0.4 * 0.05 * 0.05 + d * d);
  return pendulum(g * (m * length / 2 + 3 * d) / inertia, 0.5, end);
}

/// The bound is that of the bar on the drum.
TEST(ABob, SwingsAsAPhysicalPendulum) {
  for (const char* model : {"super_helix", "super_clothoid"}) {
    Text text = bob();
    text.model = std::string("id = \"") + model + "\"";
    World world(scene_of(text));
    ASSERT_EQ(world.advance(1), Status::ok) << world.failure();
    std::printf("%s: angle %.8f, rigid %.8f\n", model, angle_of(world), bob_at(1));
    EXPECT_NEAR(angle_of(world), bob_at(1), 2e-5) << model;
  }
}

/// Every method either refuses the scene or ends near the pendulum. Backward Euler's
/// error is omega^2 dt t/2 of the amplitude, 2e-3.
TEST(ABob, SwingsByEveryMethod) {
  std::size_t driven = 0;
  for (const IntegratorEntry& method : integrator_catalogue()) {
    Text text = bob();
    text.model = "id = \"super_helix\"";
    Status status = Status::ok;
    std::string why, failure;
    for (const char* step : {"1e-3", "1e-5"}) {
      text.integrator = "id = \"" + std::string(method.id) + "\"\n" +
                        (method.adaptive ? "" : "dt_s = " + std::string(step) + "\n");
      why = refusal([&] { scene_of(text); });
      if (!why.empty()) break;
      World world(scene_of(text));
      status = world.advance(0.1);
      failure = world.failure();
      if (status != Status::ok) continue;
      ++driven;
      const double off = std::abs(angle_of(world) - bob_at(0.1));
      std::printf("%s %s: %.1e off\n", std::string(method.id).c_str(), step, off);
      EXPECT_LE(off, 4e-3) << method.id;
      break;
    }
    if (!why.empty()) std::printf("%s\n", why.c_str());
    EXPECT_TRUE(status == Status::ok) << method.id << failure;
  }
  EXPECT_GE(driven, 20U);
}

/// Half the step, error by 2^order of the method under the scene's formulation. The bar's
/// frequency of 400/s is resolved. Bar: a third of an order, as higher terms remain.
TEST(ABob, SwingsWithTheOrderOfImplicitMethods) {
  const auto place = [](const std::string& method, const char* step) {
    Text text = bob();
    text.integrator = "id = \"" + method + "\"\ndt_s = " + step;
    World world(scene_of(text));
    EXPECT_EQ(world.advance(0.04), Status::ok) << method << world.failure();
    return world.body_motions().front().x;
  };
  const Vec exact = place("radau5", "1e-4");
  for (const char* id : {"backward_euler", "bdf2", "implicit_midpoint", "tr_bdf2",
                         "newmark", "generalized_alpha", "esdirk43"}) {
    Text text = bob();
    text.integrator = "id = \"" + std::string(id) + "\"\ndt_s = 1e-3";
    const int order = integrators::find_integrator(id)
                          .order(scene_of(text).options.formulation)
                          .value();
    const double coarse = norm(place(id, "4e-4") - exact),
                 fine = norm(place(id, "2e-4") - exact);
    std::printf("%s: %.1e, %.1e m, order %.2f of %d\n", id, coarse, fine,
                std::log2(coarse / fine), order);
    EXPECT_TRUE(fine < 1e-12 || std::log2(coarse / fine) > order - 1.0 / 3) << id;
  }
}

TEST(ABob, HasColumnsOfItsMotion) {
  const Scene scene = scene_of(bob());
  World world(scene);
  Readout readout(scene, world);
  ASSERT_EQ(world.advance(0.02), Status::ok) << world.failure();
  const Frame3d frame = readout.read(world);
  ASSERT_EQ(frame.series.size(), readout.series().size());
  const auto column = [&](const std::string& name) {
    return testing_support::column(readout, frame, name);
  };
  const auto motion = world.body_motions().front();
  EXPECT_EQ(column("position_body_z_m"), motion.x.z);
  EXPECT_EQ(column("velocity_body_x_m_per_s"), motion.v.x);
  EXPECT_EQ(column("spin_body_y_rad_per_s"), motion.omega.y);
  EXPECT_GT(column("orientation_body_w"), 0.9);
  EXPECT_NEAR(column("gravity_j"),
              3 * g * motion.x.z + Text::mass() * g * motion.x.z / 2 / 0.56 * 0.5, 1e-2);
  EXPECT_GT(column("force_strand_0_at_tip_z_n"), -40);
  EXPECT_LT(column("force_strand_0_at_tip_z_n"), -15);
}

TEST(ABob, RefusesWhatItDoesNotAdmit) {
  const auto says = [](Text text, const std::string& from, const std::string& to,
                       const char* reason) {
    std::string words = text.text();
    const std::size_t at = words.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    words.replace(at, from.size(), to);
    const std::string found = refusal([&] { World(parse_scene(words, "bar.toml")); });
    EXPECT_NE(found.find(reason), std::string::npos) << from << ": " << found;
    EXPECT_NE(found.find("bar.toml:"), std::string::npos) << found;
  };
  const Text text = bob();
  says(text, "mass_kg = 3", "mass_kg = 0", "mass_kg");
  says(text, "mass_kg = 3", "mass_kg = -1", "mass_kg");
  says(text, "mass_kg = 3", "mass_kg = nan", "mass_kg");
  says(text, "mass_kg = 3", "mass_kg = 3\nprincipal_inertias_kg_m2 = [1, 1, 3]",
       "triangle inequality");
  says(text, "mass_kg = 3", "mass_kg = 3\nprincipal_inertias_kg_m2 = [1, 0, 1]",
       "not all positive");
  says(text, "shape = \"sphere\"\nradius_m = 0.05", "shape = \"plane\"",
       "without moments of inertia");
  says(text, "mass_kg = 3", "mass_kg = 3\nfriction_law = \"exact\"", "moves = \"free\"");
  says(text, "kind = \"clamp\"", "kind = \"direction\"", "kind = \"direction\"");
  says(text, "kind = \"clamp\"", "kind = \"ball\"\nstiffness_n_per_m = 1",
       "stiffness_n_per_m of a support");
  says(text, "on = \"body\"", "on = \"bod\"", "on 'bod'");
  says(text, "kind = \"clamp\"", "at = \"root\"\nkind = \"ball\"",
       "a second support of the same point");
  says(text, "motion = \"free\"\n", "", "the root, which is clamped");
}

}  // namespace tress::test_body_supports
