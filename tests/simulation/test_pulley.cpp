// A rope that turns a pulley, against Atwood's machine.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "contract/read_file.h"
#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "tests/support/columns.h"
#include "tests/support/refusal.h"

namespace tress::test_pulley {

using namespace simulation;
using testing_support::refusal;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

const std::string& scene_text() {
  static const std::string text = read_file(TRESS_SCENES "/pulley.toml", 1 << 20);
  return text;
}

struct Turned {
  double angle, speed;  // of the body, at the end
};

Turned run(const std::string& text, double end) {
  const Scene scene = parse_scene(text, "pulley.toml");
  World world(scene);
  EXPECT_EQ(world.advance(end), Status::ok) << world.failure();
  const auto motions = world.body_motions();
  EXPECT_EQ(motions.size(), 1U);
  return {motions.front().angle, motions.front().speed};
}

/// An inextensible limp rope on a pulley, x the half of the difference of its sides:
/// (m L + I/r^2) x'' = 2 m g x.
struct Atwood {
  double inertia = 6.6e-3;
  double r = 0.201;
  double start = 0.15;
  double per_length = std::numbers::pi * 1e-6 * 13000;
  double rate() const {
    return std::sqrt(2 * per_length * 9.81 / (4 * per_length + inertia / (r * r)));
  }
  double angle(double t) const { return start * (std::cosh(rate() * t) - 1) / r; }
};

class Pulley : public testing::TestWithParam<std::string> {};

/// The bound of 0.5 % covers what the rope of the closed form does not have. The chords
/// of 4 cm are 0.5 % of r nearer to the axis than their ends, on average a third of that.
/// Bending stiffness lifts both sides off by EI/(2 T r) = 0.1 % of r. The rope stretches
/// by 0.1 %, and what sticks creeps by 1e-4 m/s, 0.04 % of the speed at the end. The
/// angle is compared, the acceleration integrated twice: the speed oscillates as the rope
/// begins to stretch at t = 0.
void expect_atwood_of(const std::string& text, double end, double inertia = 6.6e-3) {
  const double exact = Atwood{.inertia = inertia}.angle(end);
  EXPECT_NEAR(run(text, end).angle, exact, 5e-3 * exact);
}

void expect_atwood(const std::string& model, double inertia, double end) {
  std::string text = replaced(scene_text(), "id = \"der\"", "id = \"" + model + "\"");
  // Rigid links have their corners on the pulley.
  if (model != "articulated_chain") {
    text = replaced(text, "elements = 200", "elements = 100");
    text = replaced(text, "dt_s = 2e-3", "dt_s = 4e-3");
  }
  expect_atwood_of(replaced(text, "6.6e-3", std::to_string(inertia)), end, inertia);
}

TEST_P(Pulley, TurnsAsAtwoodsMachine) { expect_atwood(GetParam(), 6.6e-3, 1); }

/// A pulley of a thousandth of the rope's inertia: equations that are solved in turn
/// would be unstable.
TEST(APulley, MayBeLight) {
  expect_atwood("der", 6e-6, 0.8);
  expect_atwood("super_helix", 6e-6, 0.6);
}

INSTANTIATE_TEST_SUITE_P(Models, Pulley,
                         testing::Values("der", "mass_spring", "corde", "super_helix",
                                         "super_clothoid", "articulated_chain"),
                         [](const auto& one) { return one.param; });

/// The scene's rope and a second one beside it.
std::string two_ropes() {
  std::string text = scene_text();
  const std::size_t from = text.find("[strand]"), to = text.find("[root]");
  const std::string one =
      replaced(text.substr(from, to - from), "[strand]", "[[strand]]");
  std::string second = one;
  for (std::size_t at = 0; (at = second.find(", 0, ", at)) != std::string::npos; ++at) {
    second.replace(at, 5, ", 0.02, ");
  }
  return text.substr(0, from) + one + second + text.substr(to);
}

/// Two ropes turn a pulley as one turns a pulley of half the inertia. Newton's iteration
/// ends at 1e-9 of the typical coordinates, 500 times.
TEST(APulley, IsTurnedByTwoRopesAsByOne) {
  for (const char* model : {"der", "super_helix"}) {
    const auto angle = [&](std::string text, const std::string& inertia) {
      text = replaced(text, "id = \"der\"", std::string("id = \"") + model + "\"");
      text = replaced(text, "6.6e-3", inertia);
      for (std::size_t at = 0;
           (at = text.find("elements = 200", at)) != std::string::npos;) {
        text.replace(at, 14, "elements = 50");
      }
      return run(text, 0.5).angle;
    };
    const double one = angle(scene_text(), "6.6e-3");
    EXPECT_GT(one, 0.1) << model;
    EXPECT_NEAR(angle(two_ropes(), "1.32e-2"), one, 5e-7 * one) << model;
  }
}

/// The rope without stretch: constraints of its own.
TEST(APulley, IsTurnedByAnInextensibleRope) {
  std::string text =
      replaced(scene_text(), "id = \"der\"", "id = \"der\"\nstretch = \"inextensible\"");
  text = replaced(text, "id = \"bdf2\"", "id = \"bdf2\"\nformulation = \"projection\"");
  expect_atwood_of(replaced(text, "elements = 200", "elements = 100"), 0.5);
}

/// A support holds one side. On a drum at rest the tensions differ by M/r. Chords of
/// h = 4 m/60 lie nearer to the axis than their ends by up to h^2/(8 r^2) = 1.4 % of r.
TEST(APulley, PullsAtASupportByItsMoment) {
  const auto force = [](const std::string& moment) {
    std::string text = replaced(scene_text(), "moves = \"turns\"\n",
                                "moves = \"turns\"\nbearing_damping_n_m_s = 0.5\n"
                                "torque_n_m = " +
                                    moment + "\n");
    text = replaced(text, "elements = 200", "elements = 60");
    text = replaced(text, "[effects.gravity]",
                    "[effects.linear_drag]\ndrag_kg_m_s = 0.1\n[effects.gravity]");
    text = replaced(text, "[root]", "[[supports]]\nat = \"tip\"\n[root]");
    text = replaced(text, "dt_s = 2e-3", "dt_s = 2e-2");
    const Scene scene = parse_scene(text, "pulley.toml");
    World world(scene);
    EXPECT_EQ(world.advance(20), Status::ok) << world.failure();
    EXPECT_LT(std::abs(world.body_motions().front().speed), 1e-4);
    return world.support_loads().forces[2];
  };
  EXPECT_NEAR(force("0.02") - force("-0.02"), -0.04 / 0.201, 0.014 * 0.04 / 0.201);
}

/// A drum that nothing touches: I omega' = M - c omega.
TEST(APulley, ABodyWithoutContactFollowsItsMomentAndBearing) {
  std::string text = replaced(scene_text(), "radius_m = 0.2\n", "radius_m = 0.1\n");
  text = replaced(text, "[root]\nmotion = \"free\"", "");
  text = replaced(text, "moves = \"turns\"\n",
                  "moves = \"turns\"\ntorque_n_m = 0.02\nbearing_damping_n_m_s = "
                  "0.01\nangular_velocity_rad_per_s = -3\n");
  text = replaced(text, "elements = 200", "elements = 20");
  const double rate = 0.01 / 6.6e-3, steady = 2, t = 0.1;
  const Turned body = run(text, t);
  // bdf2 begins with a step of first order, whose error is the speed's change times
  // (rate dt)^2/2 = 5e-6, and that of the angle speed' dt^2/2 = 1.5e-5. Later steps add
  // 2/3 (rate dt)^2 rate t of it.
  EXPECT_NEAR(body.speed, steady - 5 * std::exp(-rate * t), 4e-5);
  EXPECT_NEAR(body.angle, steady * t - 5 / rate * (1 - std::exp(-rate * t)), 4e-5);
}

TEST(APulley, WritesItsAngleAndSpeed) {
  const Scene scene = parse_scene(
      replaced(scene_text(), "elements = 200", "elements = 40"), "pulley.toml");
  World world(scene);
  Readout readout(scene, world);
  ASSERT_EQ(world.advance(0.02), Status::ok) << world.failure();
  const Frame3d frame = readout.read(world);
  ASSERT_EQ(frame.series.size(), readout.series().size());
  const auto column = [&](const std::string& name) {
    return testing_support::column(readout, frame, name);
  };
  EXPECT_EQ(column("angle_body_rad"), world.body_motions().front().angle);
  EXPECT_EQ(column("speed_body_rad_per_s"), world.body_motions().front().speed);
  EXPECT_GT(column("speed_body_rad_per_s"), 0);
}

TEST(APulley, RefusesWhatItsEquationsLeaveOut) {
  const auto refused = [](const std::string& from, const std::string& to) {
    const std::string text = replaced(scene_text(), from, to);
    return refusal([&] { World(parse_scene(text, "pulley.toml")); });
  };
  const auto says = [](const std::string& found, const char* reason) {
    EXPECT_NE(found.find(reason), std::string::npos) << found;
  };
  says(refused("friction = 1\nslip_speed_m_s = 1e-4", "friction_law = \"exact\""),
       "moves = \"turns\" next to friction_law = \"exact\"");
  says(refusal([&] {
         World(parse_scene("failed_strands = \"stay\"\n" + two_ropes(), "pulley.toml"));
       }),
       "failed_strands = \"stay\" for strands that drive a body");
  says(refused("inertia_kg_m2 = 6.6e-3", "inertia_kg_m2 = 0"), "inertia_kg_m2");
  says(refused("axis = [0, 1, 0]", "axis = [0, 0, 0]"), "axis has no direction");
  says(refused("moves = \"turns\"", "moves = \"fixed\""),
       "does nothing with moves = \"fixed\"");
}

}  // namespace tress::test_pulley
