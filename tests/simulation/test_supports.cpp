// Scenes with [[supports]]: the catenary, forces of supports among the columns, and what
// is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "contract/input_error.h"
#include "models/effects/body.h"
#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "simulation/scene_text/write_scene.h"
#include "tests/support/refusal.h"

namespace tress::test_supports {

using namespace simulation;
using testing_support::refusal;

struct Text {
  std::string model = "id = \"super_helix\"", integrator = "id = \"generalized_alpha\"";
  std::string strand = "length_m = 1\nelements = 20", root = "motion = \"free\"";
  std::string supports =
      "[[supports]]\nat = \"root\"\n[[supports]]\nkeyframes = [[0, 0.5, 0, 0]]\n";
  std::string top, rest;
};

std::string text_of(const Text& text) {
  return "title = \"held\"\nduration_s = 0.1\n" + text.top + "[model]\n" + text.model +
         "\n[integrator]\n" + text.integrator +
         "\n[material]\nname = \"custom\"\nradius_m = 40e-6\nyoungs_modulus_pa = "
         "3e5\npoisson_ratio = 0.45\ndensity_kg_m3 = 1300\n[strand]\n" +
         text.strand + "\n[root]\n" + text.root + "\n" + text.supports +
         "[effects.gravity]\n" + text.rest;
}

Scene scene_of(const Text& text) { return parse_scene(text_of(text), "held.toml"); }

/// The horizontal force of a catenary of length 1 m over a span of `distance`, per weight
/// of a metre: a with 2 a sinh(distance/(2 a)) = 1.
double catenary(double distance) {
  double low = 1e-3, high = 100;
  for (int i = 0; i < 200; ++i) {
    const double a = std::sqrt(low * high);
    (2 * a * std::sinh(distance / (2 * a)) > 1 ? low : high) = a;
  }
  return low;
}

/// EI/(w L^3) = 9e-9: bending changes the force by its root times 1e-2. Elements of
/// constant curvature err by order 2: 3e-5 with 20, 4e-6 with 40.
TEST(Supports, HoldALimpStrandAsACatenary) {
  const double weight = 1300 * 9.81 * std::numbers::pi * 40e-6 * 40e-6;
  for (const double distance : {0.5, 0.9}) {
    Text text;
    text.strand = "length_m = 1\nelements = 40";
    text.supports = "[[supports]]\nat = \"root\"\n[[supports]]\nkeyframes = [[0, " +
                    std::to_string(distance) + ", 0, 0]]\n";
    World world(scene_of(text));
    const std::vector<double> force = world.support_loads().forces;
    ASSERT_EQ(force.size(), 6U);
    const double expected = catenary(distance) * weight;
    std::printf("distance %g: horizontal force %.2e off, vertical %.1e\n", distance,
                force[3] / expected - 1, force[2] / (weight / 2) - 1);
    EXPECT_NEAR(force[3] / expected, 1, 1e-5);
    EXPECT_NEAR(force[0] / expected, -1, 1e-5);
    EXPECT_NEAR(force[2] / (weight / 2), 1, 1e-9);
    EXPECT_NEAR(force[5] / (weight / 2), 1, 1e-9);
    ASSERT_EQ(world.supported_starts().size(), 1U);
    EXPECT_NE(world.supported_starts().front().find("strand 0 begins at rest"),
              std::string::npos);
  }
}

/// The start is an equilibrium: a run leaves the points where they are, within what
/// rounding of the balance moves a strand in 0.1 s, g t^2/2 times 1e-9.
TEST(Supports, BeginInAnEquilibrium) {
  World world(scene_of({}));
  const std::vector<double> before = world.positions();
  ASSERT_EQ(world.advance(0.1), Status::ok) << world.failure();
  double moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    moved = std::max(moved, std::abs(world.positions()[i] - before[i]));
  }
  EXPECT_LE(moved, 1e-8);
}

/// Columns hold the force on the strand, and the point follows its keyframes.
TEST(Supports, WriteTheirForcesAmongTheColumns) {
  Text text;
  text.supports =
      "[[supports]]\nat = \"root\"\n[[supports]]\nkeyframes = [[0, 0.5, 0, 0], [0.1, "
      "0.6, 0, 0.1]]\n";
  const Scene scene = scene_of(text);
  EXPECT_EQ(scene.options.formulation, Formulation::index3);
  World world(scene);
  Readout readout(scene, world);
  ASSERT_EQ(world.advance(0.05), Status::ok) << world.failure();
  // Halfway of a quintic.
  const std::vector<double>& x = world.positions();
  EXPECT_NEAR(x[60], 0.55, 1e-12);
  EXPECT_NEAR(x[62], 0.05, 1e-12);
  const Frame3d frame = readout.read(world);
  ASSERT_EQ(frame.series.size(), readout.series().size());
  const std::vector<double> force = world.support_loads().forces;
  const auto column =
      std::ranges::find(readout.series(), "force_strand_0_at_tip_x_n", &Reading::name);
  ASSERT_NE(column, readout.series().end());
  EXPECT_EQ(frame.series[std::size_t(column - readout.series().begin())], force[3]);
  // For arrows: place and force of each.
  ASSERT_EQ(frame.reactions.size(), 12U);
  EXPECT_FLOAT_EQ(frame.reactions[6], 0.55F);
  EXPECT_EQ(frame.reactions[9], static_cast<float>(force[3]));
}

/// Models whose points are coordinates, and one with constraints of its own.
TEST(Supports, HoldEveryModelOfAStrand) {
  for (const ModelEntry& model : model_catalogue()) {
    // No accelerations of its points.
    if (model.on_strand == nullptr || model.id == "kirchhoff_nodal") continue;
    SCOPED_TRACE(model.id);
    Text text;
    text.model = "id = \"" + std::string(model.id) + "\"";
    text.strand = "length_m = 1\nelements = 10";
    text.root = "";
    text.supports = "[[supports]]\nkeyframes = [[0, 0.7, 0, 0], [0.1, 0.6, 0, 0]]\n";
    const Scene scene = scene_of(text);
    World world(scene);
    const Status status = world.advance(0.1);
    EXPECT_EQ(status, Status::ok) << model.id << ": " << world.failure();
    const std::size_t points = world.positions().size();
    EXPECT_NEAR(world.positions()[points - 3], 0.6, 1e-9) << model.id;
    const std::vector<double> force = world.support_loads().forces;
    EXPECT_GT(force[2], 0) << model.id;
  }
}

TEST(Supports, AreWrittenBack) {
  const Scene scene = scene_of({});
  const Scene again = parse_scene(scene_text(scene), "again.toml");
  World first(scene), second(again);
  EXPECT_EQ(first.support_loads().forces, second.support_loads().forces);
}

/// The line of a refusal, without the text of the scene.
std::string refused(const Text& text) {
  return refusal([&] { World{scene_of(text)}; });
}

TEST(Supports, AreRefusedInOneLineWithPlaceAndRemedy) {
  const auto with = [](const std::string& supports) {
    Text text;
    text.supports = supports;
    return text;
  };
  EXPECT_EQ(refused(with("[[supports]]\nat = 0.33\n")),
            "no point at 0.33 of strand 0 (held.toml:19:6): give at = 0.35, the nearest "
            "end of an element, or other elements");
  EXPECT_EQ(refused(with("[[supports]]\nat = 2\n")),
            "no point at 2 of strand 0 (held.toml:19:6): give \"tip\", \"root\" or a "
            "number of 0 to 1");
  EXPECT_EQ(refused(with("[[supports]]\nstrand = 1\n")),
            "a support of strand 1 (held.toml:19:10): the scene has 1 strand, the first "
            "is 0");
  EXPECT_EQ(refused(with("[[supports]]\nkeyframes = [[0, 0, 0, 0], [0, 1, 0, 0]]\n")),
            "keyframes not ascending in time: row 2 at 0 s after 0 s (held.toml:19:13): "
            "give each "
            "a later time than the one before");
  EXPECT_NE(refused(with("[[supports]]\nkeyframes = [[0, nan, 0, 0]]\n")), "");
  EXPECT_EQ(refused(with("[[supports]]\nkind = \"direction\"\nkeyframes = [[0, 1, 0, "
                         "0]]\n")),
            "keyframes of a support with kind = \"direction\", which holds no position "
            "(held.toml:20:13): leave it out, or give kind = \"clamp\"");
  EXPECT_EQ(refused(with("[[supports]]\ndirections = [[0, 1, 0, 0]]\n")),
            "directions of a support with kind = \"ball\", which holds no direction "
            "(held.toml:19:14): leave it out, or give kind = \"clamp\"");
  EXPECT_EQ(
      refused(with("[[supports]]\nkind = \"clamp\"\ndirections = [[0, 0, 0, 0]]\n")),
      "row 1 of directions has length 0 (held.toml:20:14): give each direction at least "
      "one "
      "component that is not 0");
  EXPECT_EQ(refused(with("[[supports]]\nkind = \"clamp\"\ndirections = [[0, 1, 0, 0], "
                         "[1, -2, 0, 0]]\n")),
            "directions of rows 1 and 2 are opposite: the way is not unique "
            "(held.toml:20:14): add a direction between them");
  EXPECT_EQ(
      refused(with("[[supports]]\nkind = \"clamp\"\ntwist_rad = [[1, 0], [0, 3]]\n")),
      "twist_rad not ascending in time: row 2 at 0 s after 1 s (held.toml:20:13): give "
      "each "
      "a later time than the one before");
  EXPECT_EQ(
      refused(with("[[supports]]\nkind = \"clamp\"\ntwist_rad = [[0, 6]]\n")),
      "a strand that begins with a twist of 6 rad (held.toml:20:13): begin with less "
      "than 2.8 rad, and twist it during the run");
  Text far;
  far.root = "";
  far.supports = "[[supports]]\nkeyframes = [[0, 0.5, 0, 0], [0.1, 1.2, 0, 0]]\n";
  EXPECT_EQ(
      refused(far),
      "a support 1.2 m from the root at t = 0.1 s, where the strand between them is "
      "1 m long (held.toml:19:13): move the support closer, or make the strand "
      "longer");
  far.supports = "[[supports]]\n";
  EXPECT_EQ(
      refused(far),
      "the strand is inextensible, and 1 m long between its support and the root, which "
      "are as far apart at t = 0 s (held.toml:18:1): move the support closer, give "
      "slack, "
      "or use [model] id = \"der\"");
  far.model = "id = \"der\"";
  EXPECT_EQ(refused(far), "");
  Text planar;
  planar.model = "id = \"super_helix\"\nmodes = \"bend_planar\"";
  planar.root = "";
  planar.supports = "[[supports]]\nkeyframes = [[0, 0.5, 0.1, 0]]\n";
  EXPECT_EQ(refused(planar),
            "a support 0.1 m outside the plane of the strand at t = 0 s "
            "(held.toml:20:13): keep it in the plane, or give [model] modes = "
            "\"bend_twist\"");
  Text nodal;
  nodal.model = "id = \"kirchhoff_nodal\"";
  nodal.root = "";
  nodal.supports = "[[supports]]\nkeyframes = [[0, 0.5, 0, 0]]\n";
  EXPECT_NE(refused(nodal).find("does not compute the accelerations of its points"),
            std::string::npos);
  Text method;
  method.integrator = "id = \"xpbd\"";
  EXPECT_NE(refused(method).find("(held.toml:6:6)"), std::string::npos)
      << refused(method);
  Text rest;
  rest.top = "rest = \"inverse\"\n";
  EXPECT_NE(refused(rest).find("[supports] with rest = \"inverse\""), std::string::npos);
}

/// A support on a body that moves by keyframes, and one on the head that turns.
const char* const moving_body =
    "[effects.body]\nshape = \"sphere\"\nradius_m = 0.05\ncentre_m = [0.4, 0, 0.2]\n"
    "moves = \"keyframes\"\naxis = [0, 1, 0]\n"
    "keyframes = [[0, 0, 0, 0, 0.3], [0.1, 0.02, 0, 0.1, 0.8]]\n";

/// The tip keeps its place on the body: constraints hold to 1e-9 of the length.
TEST(Supports, AreCarriedByBodies) {
  for (const char* model : {"super_helix", "der"}) {
    Text text;
    text.model = std::string("id = \"") + model + "\"";
    text.root = "";
    text.strand =
        "length_m = 1\nelements = 10\nshape = \"helix\"\ncurl_radius_m = "
        "0.02\ncurl_pitch_m = 0.2";
    text.integrator = "id = \"backward_euler\"\ndt_s = 5e-3";
    text.supports = "[[supports]]\nat = \"tip\"\nkind = \"clamp\"\non = \"body\"\n";
    text.rest = moving_body;
    const Scene scene = scene_of(text);
    World world(scene);
    const auto tip = [&] {
      const std::vector<double> x = world.positions();
      return load3(&x[x.size() - 3]);
    };
    const Vec begin = tip();
    const auto body = std::ranges::find_if(scene.effects, [](const EffectChoice& choice) {
      return choice.entry->id == "body";
    });
    const auto motion = models::body_motion(body->parameters, scene.head);
    ASSERT_TRUE(motion);
    const models::RootMotion path = models::carried(*motion, {begin, {}});
    EXPECT_LT(norm(path.at(0).x - begin), 1e-15);
    ASSERT_EQ(world.advance(0.03), Status::ok) << world.failure();
    EXPECT_GT(norm(path.at(0.03).x - begin), 0.01);
    EXPECT_LT(norm(tip() - path.at(0.03).x), 1e-9) << model;
  }
}

/// Root and tip on one head that moves and turns.
TEST(Supports, AreCarriedByTheHead) {
  Text text;
  text.root =
      "motion = \"keyframes\"\naxis = [0, 0, 1]\nkeyframes = [[0, 0, 0, 0, 0], [0.1, "
      "0.3, 0, 0, 1.2]]";
  text.strand = "length_m = 0.01\nelements = 10";
  text.supports = "[[supports]]\nat = \"tip\"\nkind = \"clamp\"\non = \"head\"\n";
  text.model = "id = \"der\"";
  std::string scene_text = text_of(text);
  scene_text.replace(scene_text.find("[effects.gravity]\n"), 18, "");
  const Scene scene = parse_scene(scene_text, "held.toml");
  World world(scene);
  ASSERT_EQ(world.advance(0.1), Status::ok) << world.failure();
  const std::vector<double> x = world.positions();
  const models::RootPose root = scene.head.at(0.1);
  const Vec seen = root.frame.back(load3(&x[x.size() - 3]) - root.x);
  EXPECT_LT(norm(seen - Vec{0.01, 0, 0}), 1e-9 * 0.01);
}

TEST(Supports, RefuseWhatCannotCarryThem) {
  const auto refused = [](const std::string& supports, const std::string& rest) {
    Text text;
    text.root = "";
    text.supports = supports;
    text.rest = rest;
    return refusal([&] { World(scene_of(text)); });
  };
  EXPECT_EQ(refused("[[supports]]\non = \"body\"\n", ""),
            "a support on 'body', which is no body of the scene (held.toml:19:6): leave "
            "on out, or give a body that moves");
  EXPECT_EQ(
      refused("[[supports]]\non = \"head\"\n", ""),
      "a support on \"head\", which does not move (held.toml:19:6): leave on out, or "
      "give [root] a motion of the head");
  EXPECT_EQ(
      refused("[[supports]]\non = \"body\"\n", "[[effects.body]]\n"),
      "a support on \"body\", which does not move (held.toml:19:6): leave on out, or "
      "give the body moves = \"keyframes\", \"poses\", \"turns\" or \"free\"");
  EXPECT_NE(refused("[[supports]]\non = \"bodi\"\n", moving_body).find("use \"body\""),
            std::string::npos);
  EXPECT_NE(
      refused("[[supports]]\non = \"body\"\nkeyframes = [[0, 0.5, 0, 0]]\n", moving_body)
          .find("keyframes of a support with on = \"body\", which moves it"),
      std::string::npos);
}

}  // namespace tress::test_supports
