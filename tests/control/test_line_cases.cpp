// Lines that are held and joined, after public reports about other simulators; names and
// files of the reports are left out. Each has an answer of its own, derived
// independently.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "math/vec3.h"
#include "simulation/run/world.h"

namespace tress::test_line_cases {

using namespace simulation;

constexpr double g = 9.81;  // m/s^2

Vec point(World& world, std::size_t i) { return load3(&world.positions()[3 * i]); }

/// A mooring line from an anchor on the ground to a fairlead: a part of it lies, the rest
/// hangs. On a smooth ground the lying part has the horizontal tension H everywhere. The
/// hanging one is a catenary that begins level where it leaves the ground. With a = H/w,
/// w the weight per length, and x its extent,
///
///     h = a (cosh(x/a) - 1),   s = a sinh(x/a),   (L - s) + x = X
///
/// for the height h of the fairlead, its distance X from the anchor and the length L. The
/// last equation holds what lies. The fairlead bears H and w s.
struct Mooring {
  double length = 1, height = 0.4, away = 0.8;  // L, h, X, m
  double level = 0, hanging = 0;                // a, s, m

  Mooring() {
    // s^2 = h^2 + 2 a h, and x = a asinh(s/a).
    const auto excess = [&](double a) {
      const double s = std::sqrt(height * height + 2 * a * height);
      return length - s + a * std::asinh(s / a) - away;
    };
    double low = 1e-3, high = 10;  // the excess grows with a
    for (int i = 0; i < 200; ++i) {
      level = (low + high) / 2;
      (excess(level) < 0 ? low : high) = level;
    }
    hanging = std::sqrt(height * height + 2 * level * height);
  }
};

/// The load of the fairlead on the line over its weight per length, m: (H, V)/w.
Vec fairlead(const Mooring& line, const std::string& model, int elements, double step) {
  constexpr double radius = 5e-4, density = 7800;
  const double weight = density * std::numbers::pi * radius * radius * g;
  const Scene scene = parse_scene(
      fmt::format(
          "title = \"t\"\nduration_s = 6\nframes_per_s = 10\n[model]\nid = \"{}\"\n"
          "[integrator]\nid = \"backward_euler\"\ndt_s = {}\n[material]\n"
          "name = \"custom\"\nradius_m = {}\nyoungs_modulus_pa = 1e6\n"
          "density_kg_m3 = {}\npoisson_ratio = 0.3\ninternal_friction_kg_m3_s = 0\n"
          "[strand]\nlength_m = {}\nelements = {}\nroot_tangent = [1, 0, 0]\n"
          "position_m = [0, 0, {}]\n[[supports]]\nkeyframes = [[0, 0.85, 0, 0.3], "
          "[1, {}, 0, {}]]\n[effects.gravity]\n[effects.linear_drag]\n"
          "drag_kg_m_s = 0.05\n[effects.body]\nshape = \"plane\"\nfriction = 0\n"
          "stiffness_n_m2 = {}\nstrand_radius_m = {}\n",
          model, step, radius, density, line.length, elements, radius, line.away,
          line.height + radius, weight / 1e-4, radius),
      "mooring.toml");
  World world(scene);
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    EXPECT_EQ(world.advance(scene.time_of(frame)), Status::ok) << world.failure();
    if (world.time() != scene.time_of(frame)) return {};
  }
  const auto loads = world.support_loads();
  return (1 / weight) * load3(loads.forces.data());
}

/// An element of length e has the sagitta e^2/(8 a) where the catenary is most curved: as
/// much of a may be missing. The ground yields by 1e-4 m, 4e-4 of a, and bending bears
/// E I/(H a^2) = 6e-5. Steps of another length end in the same equilibrium: drag damps
/// motion at drag/(2 rho A) = 4/s, which leaves e^-20 of it 5 s after the fairlead rests.
TEST(FieldCase, MooringLineHasTheTensionOfACatenary) {
  const Mooring line;
  constexpr int elements = 20;
  const double sagitta = std::pow(line.length / elements / line.level, 2) / 8;
  for (const char* const model : {"super_helix", "articulated_chain"}) {
    const Vec load = fairlead(line, model, elements, 0.02),
              shorter = fairlead(line, model, elements, 0.005);
    EXPECT_NEAR(load.x / line.level, 1, sagitta + 5e-4) << model;
    EXPECT_NEAR(load.z / line.hanging, 1, sagitta + 5e-4) << model;
    EXPECT_NEAR(load.y, 0, 1e-9) << model;
    EXPECT_LT(norm(load - shorter), 1e-6 * line.level) << model;
  }
}

/// Two inextensible strands that hang on each other by a spring where a ball joint would
/// be.
std::string hanging(const std::string& joint, const std::string& tangent, double step) {
  return fmt::format(
      "title = \"t\"\nduration_s = 0.2\nframes_per_s = 50\n[model]\n"
      "id = \"super_helix\"\njacobian = \"exact\"\n[integrator]\nid = \"esdirk43\"\n"
      "dt_s = {}\n[material]\nname = \"custom\"\nradius_m = 1e-3\n"
      "youngs_modulus_pa = 1e9\ndensity_kg_m3 = 1300\npoisson_ratio = 0.3\n"
      "internal_friction_kg_m3_s = 0\n[[strand]]\nname = \"upper\"\nlength_m = 0.1\n"
      "elements = 2\nroot_tangent = [0, 0, -1]\n[[strand]]\nname = \"lower\"\n"
      "root = \"free\"\nlength_m = 0.1\nelements = 2\nposition_m = [0, 0, -0.1]\n"
      "root_tangent = {}\n[[joints]]\na = [\"upper\", \"tip\"]\nb = [\"lower\", "
      "\"root\"]\n{}[effects.gravity]\n",
      step, tangent, joint);
}
constexpr double mass = 1300 * std::numbers::pi * 1e-6 * 0.1;  // kg, of a strand

std::string spring(double k, double damping) {
  return fmt::format(
      "kind = \"spring\"\nstiffness_n_per_m = {}\ndamping_n_s_per_m = {}\n"
      "rest_length_m = 0\n",
      k, damping);
}

/// Straight down nothing but the spring moves: the gap is that of a mass m on a spring k
/// which lets go at rest, (m g/k) (1 - cos w t) with w = sqrt(k/m). The error of a method
/// of order 4 is (w h)^4 of the amplitude at most, for some 5 periods.
TEST(FieldCase, SpringInPlaceOfABallJointSwingsLikeAMassOnIt) {
  constexpr double step = 1e-3;
  for (const double k : {1.0, 10.0}) {
    World world(parse_scene(hanging(spring(k, 0), "[0, 0, -1]", step), "joined.toml"));
    const double w = std::sqrt(k / mass), amplitude = mass * g / k;
    for (const double t : {0.05, 0.1, 0.2}) {
      ASSERT_EQ(world.advance(t), Status::ok) << world.failure();
      EXPECT_NEAR(point(world, 2).z - point(world, 3).z,
                  amplitude * (1 - std::cos(w * t)), amplitude * std::pow(w * step, 4))
          << k << ' ' << t;
    }
  }
}

/// A pendulum that swings on it: the spring yields by force over k, so that the tip
/// differs from that on a ball joint by c/k + c'/k^2. Where k is twice as large, half of
/// it is left; a tenth allows for c' and for steps.
TEST(FieldCase, SpringTendsToABallJoint) {
  const auto tip = [](const std::string& joint) {
    World world(parse_scene(hanging(joint, "[1, 0, 0]", 5e-4), "joined.toml"));
    EXPECT_EQ(world.advance(0.2), Status::ok) << world.failure();
    return point(world, 5);
  };
  const Vec ball = tip("kind = \"ball\"\n");
  std::vector<double> apart;
  for (const double k : {100.0, 200.0, 400.0}) {
    apart.push_back(norm(tip(spring(k, 2 * std::sqrt(k * mass))) - ball));
  }
  EXPECT_LT(apart[0], 1e-2 * 0.1);
  for (const std::size_t i : {0u, 1u}) EXPECT_NEAR(apart[i] / apart[i + 1], 2, 0.2);
}

}  // namespace tress::test_line_cases
