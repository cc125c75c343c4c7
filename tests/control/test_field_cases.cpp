// Scenes after public reports about other simulators; names and files of the reports are
// left out. Each has an answer of its own, derived independently.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "math/frame.h"
#include "math/vec3.h"
#include "simulation/run/world.h"
#include "simulation/scene_text/schema.h"

namespace tress::test_field_cases {

using namespace simulation;

using testing::HasSubstr;

Scene scene_of(const std::string& text) {
  return parse_scene("title = \"t\"\n" + text, "field.toml");
}

std::string custom(double radius, double modulus, double density, double ellipticity) {
  return "[material]\nname = \"custom\"\npoisson_ratio = 0.3\n"
         "internal_friction_kg_m3_s = 0\nradius_m = " +
         std::to_string(radius) + "\nyoungs_modulus_pa = " + std::to_string(modulus) +
         "\ndensity_kg_m3 = " + std::to_string(density) +
         "\nellipticity = " + std::to_string(ellipticity) + "\n";
}

Vec tip(World& world) {
  const std::vector<double>& x = world.positions();
  return load3(&x[x.size() - 3]);
}

/// Runs to the end; empty: all is well, else what ended it.
std::string ending(World& world, const Scene& scene) {
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    if (world.advance(scene.time_of(frame)) != Status::ok) return world.failure();
  }
  return {};
}

/// A level cantilever with an elliptic section turned by 30 degrees: each axis of the
/// section bends by w L^4/(8 E I) of its own, so that the tip leaves the vertical plane.
/// The tip is 0.8 % of the length down: terms of the next order are (0.8 %)^2 of it. 20
/// elements of constant curvature err by 1/(4 n^2) = 0.06 %, and motion damped at 200/s
/// leaves e^-100.
TEST(FieldCase, ObliqueSectionBendsAboutItsOwnAxes) {
  const Scene scene = scene_of(
      "duration_s = 1\nframes_per_s = 10\n[model]\nid = \"super_helix\"\n[integrator]\n"
      "id = \"backward_euler\"\ndt_s = 1e-3\n" +
      custom(1e-3, 1e9, 1000, 2) +
      "[strand]\nlength_m = 0.1\nelements = 20\nroot_tangent = [1, 0, 0]\n"
      "normal = [0, 0.8660254037844386, 0.5]\n[effects.gravity]\n"
      "[effects.linear_drag]\ndrag_kg_m_s = 0\nmass_damping_per_s = 200\n");
  World world(scene);
  ASSERT_EQ(ending(world, scene), "");
  EXPECT_NEAR(tip(world).y, 0.3186e-3, 2e-3 * 0.3186e-3);
  EXPECT_NEAR(tip(world).z, -0.7971e-3, 2e-3 * 0.7971e-3);
}

/// A limp chain bent into its first mode crosses the vertical after a quarter of the
/// period 2 pi/(j/2 sqrt(g/L)), j = 2.4048 the first zero of J_0: 0.41709 s. Its
/// amplitude of 0.02 L changes that by (0.02)^2/16, its stiffness by less; frames of 2 ms
/// are interpolated linearly, which errs by (w h)^2/8 of 2 ms.
TEST(FieldCase, LimpStrandSwingsInTheFirstModeOfAChain) {
  constexpr double j = 2.404825557695773, g = 9.81;
  const double quarter = std::acos(-1.0) / (j * std::sqrt(g));
  std::string points;
  for (int i = 0; i <= 16; ++i) {  // J_0(j sqrt(1 - s)) of arc length s
    const double s = i / 16.0;
    points += (i > 0 ? ", [" : "[") +
              std::to_string(0.02 * std::cyl_bessel_j(0, j * std::sqrt(1 - s))) +
              ", 0, " + std::to_string(-s) + "]";
  }
  const Scene scene = scene_of(
      "duration_s = 0.44\nframes_per_s = 500\n[model]\nid = "
      "\"super_helix\"\n[integrator]\n"
      "id = \"esdirk43\"\ndt_s = 0.001\n" +
      custom(1e-3, 1e5, 1000, 1) +
      "[strand]\nelements = 20\nnatural = \"straight\"\nnormal = [0, 1, 0]\npoints = [" +
      points + "]\n[effects.gravity]\n");
  World world(scene);
  double before = tip(world).x, crossed = 0;
  for (std::size_t frame = 1; crossed == 0 && frame <= scene.last_frame(); ++frame) {
    ASSERT_EQ(world.advance(scene.time_of(frame)), Status::ok) << world.failure();
    const double now = tip(world).x;
    if (now < 0) crossed = scene.time_of(frame) - 0.002 * now / (now - before);
    before = now;
    EXPECT_EQ(tip(world).y, 0);
  }
  EXPECT_NEAR(crossed, quarter, 2e-4);
}

std::string pendulum(const std::string& integrator) {
  return "duration_s = 4\nframes_per_s = 50\n[model]\nid = \"inextensible_chain\"\n"
         "links = 1\n[integrator]\n" +
         integrator;
}

double energy(World& world) {
  const Energies now = world.energies();
  double sum = now.kinetic + now.elastic;
  for (const double of_effect : now.effects) sum += of_effect;
  return sum;
}

/// One pendulum with its constraint in every form. Drift of the energy over 4 s, over the
/// largest kinetic energy, is what was measured over 100 s at most, 6e-4.
TEST(FieldCase, PendulumKeepsItsEnergyInEveryFormOfItsConstraint) {
  struct Form {
    std::string integrator;
    double drift;
  };
  const std::string step = "dt_s = 0.01\n", rtol = "rtol = 1e-6\n";
  const auto form = [](const std::string& id, const std::string& formulation) {
    return "id = \"" + id + "\"\nformulation = \"" + formulation + "\"\n";
  };
  for (const auto& [integrator, drift] :
       {Form{form("esdirk43", "projection") + step, 1e-7},
        Form{form("esdirk43", "acceleration") + step, 1e-6},
        Form{form("esdirk43", "baumgarte") + step + "alpha = 100\nbeta = 20\n", 1e-6},
        Form{form("esdirk43", "index3") + step, 6e-4},
        Form{form("rk4", "projection") + step, 1e-6},
        Form{form("rattle", "rattle") + step, 6e-4},
        Form{form("cvode_bdf", "acceleration") + rtol, 6e-4},
        Form{form("ida", "index2_ggl") + rtol, 6e-4}}) {
    const Scene scene = scene_of(pendulum(integrator));
    World world(scene);
    const double begin = energy(world);
    double most = 0, kinetic = 0;
    for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
      ASSERT_EQ(world.advance(scene.time_of(frame)), Status::ok) << world.failure();
      most = std::max(most, std::abs(energy(world) - begin));
      kinetic = std::max(kinetic, world.energies().kinetic);
    }
    EXPECT_GT(kinetic, 0);
    EXPECT_LE(most, drift * kinetic) << integrator;
  }
}

std::string refusal_of(const std::string& text) {
  try {
    const Scene scene = scene_of(text);
    World world(scene);
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(FieldCase, PendulumIsRefusedWithAReasonWhereAFormDoesNotApply) {
  EXPECT_THAT(refusal_of(pendulum(
                  "id = \"esdirk43\"\nformulation = \"index2_ggl\"\ndt_s = 0.01\n")),
              HasSubstr("no second multiplier"));
  EXPECT_THAT(refusal_of(pendulum(
                  "id = \"implicit_midpoint\"\nformulation = \"index3\"\ndt_s = 0.01\n")),
              HasSubstr("unstable on index 3"));
}

std::string moved(const std::string& integrator) {
  return "duration_s = 0.3\nframes_per_s = 100\n[model]\nid = \"inextensible_strand\"\n"
         "[integrator]\n" +
         integrator + custom(5e-4, 1e8, 1200, 1) +
         "[strand]\nlength_m = 0.2\nelements = 10\nroot_tangent = [0, 0, -1]\n[root]\n"
         "motion = \"shake\"\namplitude_m = 0.05\nfrequency_hz = 3\n[effects.gravity]\n";
}

/// A strand whose root moves from the first instant on: the initial state satisfies the
/// constraints and their rate, and methods of different families start alike. rattle has
/// order 2 and a step of 0.5 ms, the others are converged to 2e-6 m.
TEST(FieldCase, MethodsAgreeFromAStartWithAMovingRoot) {
  const auto end = [](const std::string& integrator) {
    const Scene scene = scene_of(moved(integrator));
    World world(scene);
    EXPECT_EQ(ending(world, scene), "");
    return tip(world);
  };
  const Vec exact = end("id = \"esdirk43\"\nformulation = \"index3\"\ndt_s = 0.0005\n");
  for (const char* const integrator :
       {"id = \"ida\"\nformulation = \"index2_ggl\"\nrtol = 1e-6\n",
        "id = \"cvode_bdf\"\nformulation = \"projection\"\nrtol = 1e-6\n",
        "id = \"rattle\"\nformulation = \"rattle\"\ndt_s = 0.0005\n"}) {
    EXPECT_LE(norm(end(integrator) - exact), 3e-6) << integrator;
  }
  const Scene index3 =
      scene_of(moved("id = \"ida\"\nformulation = \"index3\"\nrtol = 1e-6\n"));
  World world(index3);
  EXPECT_THAT(ending(world, index3), HasSubstr("ida"));  // stops, and says so
}

/// A hair at rest on a slope of 0.29 under a coefficient of friction of 0.5. Regularised
/// friction mu N (2 x - x^2), x the speed over the slip speed of 1 mm/s, holds the weight
/// where 2 x - x^2 = 0.29/0.5: x = 0.3519.
Scene slope(const std::string& law) {
  return scene_of(
      "duration_s = 0.2\nframes_per_s = 30\n[model]\nid = \"super_helix\"\n[integrator]\n"
      "id = \"backward_euler\"\ndt_s = 0.001\n[material]\nname = \"hair.asian\"\n"
      "ellipticity = 1\n[strand]\nlength_m = 0.1\nelements = 10\n"
      "root_tangent = [1, 0, -0.29]\n[root]\nmotion = \"free\"\n[effects.gravity]\n"
      "[effects.body]\nshape = \"plane\"\ncentre_m = [-1.114e-5, 0, -3.8417e-5]\n"
      "rotation_rad = [0, 0.28229968, 0]\nfriction = 0.5\n" +
      law);
}

/// Speed of the tip over the last tenth of a second, m/s.
double creep(const Scene& scene) {
  World world(scene);
  const std::size_t last = scene.last_frame(), middle = last / 2;
  Vec from;
  for (std::size_t frame = 1; frame <= last; ++frame) {
    EXPECT_EQ(world.advance(scene.time_of(frame)), Status::ok) << world.failure();
    if (frame == middle) from = tip(world);
  }
  return norm(tip(world) - from) / (scene.time_of(last) - scene.time_of(middle));
}

TEST(FieldCase, HairOnASlopeCreepsByTheRegularisedLawOnly) {
  EXPECT_NEAR(creep(slope("friction_law = \"regularised\"\n")), 0.3519e-3, 5e-7);
  EXPECT_LE(creep(slope("friction_law = \"exact\"\nnormal = \"rigid\"\n")), 1e-12);
}

/// A system of units: SI units per its units of length, mass and time.
struct Units {
  const char* name;
  double metre, kilogram, second;
};

/// A curl that swings in air, in these units, all turned by `angle` about an axis that is
/// none of the three.
std::string swinging(const char* model, const char* method, const Units& of,
                     double angle) {
  const auto unit = [&of](double si, int length, int mass, int time) {
    return number_text(si * std::pow(of.metre, length) * std::pow(of.kilogram, mass) *
                       std::pow(of.second, time));
  };
  const Frame turned = rotation((1 / norm(Vec{1, 2, 3})) * Vec{1, 2, 3}, angle);
  const auto direction = [&](const Vec& x) {
    const Vec y = turned * x;
    return "[" + number_text(y.x) + ", " + number_text(y.y) + ", " + number_text(y.z) +
           "]";
  };
  const Vec down = turned * Vec{0, 0, -9.81};
  return "duration_s = " + unit(0.1, 0, 0, 1) + "\nframes_per_s = " + unit(50, 0, 0, -1) +
         "\n[model]\nid = \"" + model + "\"\n[integrator]\nid = \"" + method +
         "\"\ndt_s = " + unit(0.002, 0, 0, 1) +
         "\nnewton_tolerance = 1e-13\n[material]\nname = \"custom\"\npoisson_ratio = "
         "0.3\n"
         "radius_m = " +
         unit(1e-4, 1, 0, 0) + "\nyoungs_modulus_pa = " + unit(1e8, -1, 1, -2) +
         "\ndensity_kg_m3 = " + unit(1300, -3, 1, 0) +
         "\ninternal_friction_kg_m3_s = " + unit(1e-11, 3, 1, -1) +
         "\n[strand]\nlength_m = " + unit(0.1, 1, 0, 0) +
         "\nelements = 8\nroot_tangent = " + direction({1, 0, 0}) +
         "\nnormal = " + direction({0, 0, 1}) +
         "\nshape = \"helix\"\ncurl_radius_m = " + unit(0.01, 1, 0, 0) +
         "\ncurl_pitch_m = " + unit(0.03, 1, 0, 0) +
         "\n[effects.gravity]\ngravity_m_s2 = [" + unit(down.x, 1, 0, -2) + ", " +
         unit(down.y, 1, 0, -2) + ", " + unit(down.z, 1, 0, -2) +
         "]\n[effects.linear_drag]\ndrag_kg_m_s = " + unit(1e-4, -1, 1, -1) + "\n";
}

std::vector<double> end_of(const std::string& text) {
  const Scene scene = scene_of(text);
  World world(scene);
  EXPECT_EQ(ending(world, scene), "");
  return world.positions();
}

class OfModel : public testing::TestWithParam<std::pair<const char*, const char*>> {};

/// The physics has no units of its own. Rounding of the scaled numbers, 1e-16 each, grows
/// over 50 steps with the stiffest motion of the model, stretching with 1e6 times the
/// stiffness of bending, to 1e-9 of the length at most.
TEST_P(OfModel, UnitsDoNotMatter) {
  const auto& [model, method] = GetParam();
  const std::vector<double> si = end_of(swinging(model, method, {"SI", 1, 1, 1}, 0));
  for (const Units& of : {Units{"cm g s", 100, 1000, 1}, Units{"mm g ms", 1e3, 1e3, 1e3},
                          Units{"inch pound s", 1 / 0.0254, 1 / 0.45359237, 1},
                          Units{"dm kg s/10", 10, 1, 10}}) {
    const std::vector<double> x = end_of(swinging(model, method, of, 0));
    ASSERT_EQ(x.size(), si.size());
    double apart = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      apart = std::max(apart, std::abs(x[i] / of.metre - si[i]));
    }
    EXPECT_LT(apart, 1e-9 * 0.1) << of.name;
  }
}

/// Nor has it directions.
TEST_P(OfModel, DirectionsDoNotMatter) {
  const auto& [model, method] = GetParam();
  const std::vector<double> plain = end_of(swinging(model, method, {"SI", 1, 1, 1}, 0));
  const double angle = 10 * std::numbers::pi / 180;
  const Frame turned = rotation((1 / norm(Vec{1, 2, 3})) * Vec{1, 2, 3}, angle);
  const std::vector<double> x = end_of(swinging(model, method, {"SI", 1, 1, 1}, angle));
  double apart = 0, moved = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    apart = std::max(apart, norm(load3(&x[i]) - turned * load3(&plain[i])));
    moved = std::max(moved, norm(load3(&x[i]) - load3(&plain[i])));
  }
  EXPECT_LT(apart, 1e-9 * 0.1);
  EXPECT_GT(moved, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(FieldCase, OfModel,
                         testing::Values(std::pair{"super_helix", "tr_bdf2"},
                                         std::pair{"super_clothoid", "esdirk43"},
                                         std::pair{"articulated_chain", "bdf2"},
                                         std::pair{"der", "backward_euler"},
                                         std::pair{"corde", "generalized_alpha"},
                                         std::pair{"mass_spring",
                                                   "linearly_implicit_euler"}),
                         [](const auto& of) { return std::string(of.param.first); });

/// The scene that `simulate --print-defaults` writes runs to its end and is damped. A
/// hair of 0.1 m in air of 8e-5 kg/(m s) has the rate of damping drag/(2 rho A) = 6/s,
/// and the friction of the material adds to it: after 1 s less than e^-6 of the height
/// that it falls through is left as kinetic energy, and more than 1e-9 of it.
TEST(FieldCase, DefaultsAreAStableDampedScene) {
  const Scene scene = parse_scene(scene_defaults(), "defaults.toml");
  World world(scene);
  ASSERT_EQ(ending(world, scene), "");
  EXPECT_DOUBLE_EQ(world.time(), 1);
  double falls = 0;
  for (const double of_effect : world.energies().effects) falls -= of_effect;
  EXPECT_GT(falls, 0);
  EXPECT_LT(world.energies().kinetic, std::exp(-6) * falls);
  EXPECT_GT(world.energies().kinetic, 1e-9 * falls);
}

}  // namespace tress::test_field_cases
