// Scenes with [[joints]]: a four-bar linkage, springs and welds against closed forms and
// whole strands, every method, columns of the series, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "simulation/scene_text/write_scene.h"
#include "tests/support/refusal.h"

namespace tress::test_joints {

using namespace simulation;
using testing_support::refusal;

struct Text {
  std::string model = "id = \"super_helix\"",
              integrator = "id = \"generalized_alpha\"\ndt_s = 1e-3";
  std::string material = "radius_m = 1e-3\nyoungs_modulus_pa = 3e7\n";
  /// Two strands that hang one below the other.
  std::string strands =
      "[[strand]]\nname = \"upper\"\nlength_m = 0.1\nelements = 4\nroot_tangent = [0, 0, "
      "-1]\n[[strand]]\nname = \"lower\"\nlength_m = 0.1\nelements = 4\nroot = "
      "\"free\"\nroot_tangent = [0, 0, -1]\nposition_m = [0, 0, -0.1]\n";
  std::string root = "motion = \"shake\"\namplitude_m = 0.01\nfrequency_hz = 5\n";
  std::string joints =
      "[[joints]]\na = [\"upper\", \"tip\"]\nb = [\"lower\", \"root\"]\n";
  std::string rest = "[effects.gravity]\n";
  std::string top;
};

std::string text_of(const Text& text) {
  return "title = \"joined\"\nduration_s = 1\nframes_per_s = 100\n" + text.top +
         "[model]\n" + text.model + "\n[integrator]\n" + text.integrator +
         "\n[material]\nname = \"custom\"\npoisson_ratio = 0.45\ndensity_kg_m3 = 1300\n" +
         text.material + text.strands + "[root]\n" + text.root + text.joints + text.rest;
}

Scene scene_of(const Text& text) { return parse_scene(text_of(text), "joined.toml"); }

Vec point(World& world, std::size_t i) { return load3(&world.positions()[3 * i]); }

/// A moment at a weld would act on an edge, half an edge away from the section that the
/// weld holds. Elements that bend have that section.
TEST(Joints, RefuseMomentsAtWeldsOfEdges) {
  const auto why = [](const std::string& model, const std::string& kind) {
    Text text;
    text.model = model;
    text.joints += "kind = \"" + kind + "\"\n";
    text.rest = "[[effects.point_moment]]\nmoment_n_m = [0, 1e-9, 0]\n";
    return refusal([&] { World(scene_of(text)); });
  };
  const std::string edges = "id = \"der\"\ntwist = \"dynamic\"";
  const std::string said = why(edges, "weld");
  EXPECT_NE(said.find("the section is held"), std::string::npos) << said;
  EXPECT_NE(said.find("joined.toml:"), std::string::npos) << said;
  EXPECT_EQ(why(edges, "ball"), "");
  EXPECT_EQ(why("id = \"super_helix\"", "weld"), "");
}

/// Every method that can drive joined strands keeps their points together: by rounding of
/// Newton's method under index 3 and projection. Explicit ones take shorter steps. Tips
/// of the pendulum of 0.2 m differ by the errors of the methods alone, below 2 mm.
TEST(Joints, HoldUnderEveryMethod) {
  std::size_t driven = 0;
  Vec reference;
  for (const IntegratorEntry& method : integrator_catalogue()) {
    Status status = Status::fatal;
    std::string failure;
    Text text;
    for (const char* step : {"1e-3", "1e-5"}) {
      text.integrator = "id = \"" + std::string(method.id) + "\"\n" +
                        (method.adaptive ? "" : "dt_s = " + std::string(step) + "\n");
      const std::string why = refusal([&] { scene_of(text); });
      if (!why.empty()) break;
      World world(scene_of(text));
      status = world.advance(0.05);
      failure = world.failure();
      if (status != Status::ok) continue;
      // ida holds constraints within its tolerance of 1e-6.
      EXPECT_LE(norm(point(world, 4) - point(world, 5)), method.id == "ida" ? 1e-6 : 1e-9)
          << method.id;
      const Vec tip = point(world, 9);
      if (driven++ == 0) reference = tip;
      std::printf("%s: %.1e m, %.1e m\n", std::string(method.id).c_str(),
                  norm(point(world, 4) - point(world, 5)), norm(tip - reference));
      EXPECT_LE(norm(tip - reference), 2e-3) << method.id;
      break;
    }
    EXPECT_TRUE(status == Status::ok || failure.empty()) << method.id << failure;
  }
  EXPECT_GE(driven, 20U);
}

/// A parallelogram of three stiff bars, hinged to two fixed points and to each other,
/// released at 60 degrees. The coupler does not turn, so that (2 m/3 + m) L^2 x'' = -2 m
/// g L sin x: the period is 4 sqrt(5 L/(6 g)) K(sin 30). A method of order 2 with 470
/// steps a period errs by 5e-5 of it; the bars bend by EI/(m g L^2) = 1e5.
TEST(Joints, MakeAFourBarLinkage) {
  constexpr double angle = std::numbers::pi / 3, L = 0.5;
  const double x = L * std::sin(angle), z = -L * std::cos(angle);
  const std::string bar = "[[strand]]\nlength_m = 0.5\nelements = 1\nroot = \"free\"\n";
  Text text;
  text.integrator = "id = \"generalized_alpha\"\ndt_s = 2e-3\n";
  text.material =
      "radius_m = 1e-3\nyoungs_modulus_pa = 1e15\n"
      "internal_friction_kg_m3_s = 0\n";
  text.root = "motion = \"free\"\n";
  char tip[200];
  std::snprintf(tip, sizeof tip, "position_m = [%.17g, 0, %.17g]\n", x, z);
  char tangent[200];
  std::snprintf(tangent, sizeof tangent, "root_tangent = [%.17g, 0, %.17g]\n", x, z);
  text.strands = bar + "name = \"left\"\n" + tangent + bar +
                 "name = \"right\"\nposition_m = [0.5, 0, 0]\n" + tangent + bar +
                 "name = \"coupler\"\nroot_tangent = [1, 0, 0]\n" + tip;
  const std::string axis = "kind = \"hinge\"\naxis = [0, 1, 0]\n";
  text.joints = "[[supports]]\nstrand = 0\nat = \"root\"\n" + axis +
                "[[supports]]\nstrand = 1\nat = \"root\"\n" + axis +
                "[[joints]]\na = [\"left\", \"tip\"]\nb = [\"coupler\", \"root\"]\n" +
                axis + "[[joints]]\na = [\"right\", 1]\nb = [\"coupler\", \"tip\"]\n" +
                axis;
  World world(scene_of(text));
  EXPECT_EQ(world.systems(), 1U);
  // Zero crossings of the coupler's root: after a quarter and five quarters of a period.
  std::vector<double> crossings;
  double before = point(world, 1).x, t = 0;
  const double energy =
      world.energies().kinetic + world.energies().elastic + world.energies().effects[0];
  for (int k = 1; k * 2e-3 < 2.2 && crossings.size() < 3; ++k) {
    ASSERT_EQ(world.advance(2e-3 * k), Status::ok) << world.failure();
    const double now = point(world, 1).x;
    if (before * now < 0) crossings.push_back(t + 2e-3 * before / (before - now));
    before = now;
    t = 2e-3 * k;
    EXPECT_LE(norm(point(world, 1) - point(world, 4)), 1e-10);
    EXPECT_LE(norm(point(world, 3) - point(world, 5)), 1e-10);
  }
  ASSERT_EQ(crossings.size(), 3U);
  const double period = crossings[2] - crossings[0],
               exact = 4 * std::sqrt(5 * L / (6 * 9.81)) *
                       std::comp_ellint_1(std::sin(angle / 2));
  const double drift = world.energies().kinetic + world.energies().elastic +
                       world.energies().effects[0] - energy;
  std::printf("period %.6f s, %.2e off; energy %.1e J of %.1e\n", period,
              period / exact - 1, drift, std::abs(energy));
  EXPECT_NEAR(period / exact, 1, 1e-4);
}

/// Two strands of five elements that a weld joins move as one of ten, within the error of
/// the method: multipliers act at the end of a stage, where inner forces act in it.
/// Halved steps leave a quarter of the difference (order 2). Edges of `der` measure their
/// angle in another way, of second order in it: tips within 1e-3 of the length.
TEST(Joints, WeldTwoHalvesIntoOneStrand) {
  for (const char* model : {"super_helix", "super_clothoid", "der"}) {
    SCOPED_TRACE(model);
    const auto tip = [&](bool whole, const char* step) {
      Text text;
      text.model = "id = \"" + std::string(model) + "\"";
      text.integrator = "id = \"generalized_alpha\"\nnewton_tolerance = 1e-10\ndt_s = " +
                        std::string(step);
      text.material =
          "radius_m = 1e-3\nyoungs_modulus_pa = 3e7\n"
          "internal_friction_kg_m3_s = 1e-8\n";
      text.strands =
          "[[strand]]\nname = \"upper\"\nlength_m = 0.1\nelements = 5\nroot_tangent = "
          "[1, "
          "0, 0]\n[[strand]]\nname = \"lower\"\nlength_m = 0.1\nelements = 5\nroot = "
          "\"free\"\nroot_tangent = [1, 0, 0]\nposition_m = [0.1, 0, 0]\n";
      text.joints += "kind = \"weld\"\n";
      if (whole) {
        text.strands = "[strand]\nlength_m = 0.2\nelements = 10\n";
        text.joints.clear();
      }
      World world(scene_of(text));
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      return point(world, whole ? 10 : 11);
    };
    const double coarse = norm(tip(true, "1e-3") - tip(false, "1e-3")),
                 fine = norm(tip(true, "5e-4") - tip(false, "5e-4"));
    std::printf("%s: tips %.2e m, %.2e m apart\n", model, coarse, fine);
    EXPECT_LE(fine, 2e-4);
    if (std::string(model) == "der") continue;
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.4);
  }
}

/// A stiff bar of mass m on a spring of 20 N/m and a damper along its axis, stretched by
/// 2 cm, without gravity: x = A exp(-c t/(2 m)) (cos w t + c/(2 m w) sin w t). esdirk43
/// with 1e-3 s errs by 1e-9 of A; the clamped strand that holds the spring gives way by
/// k/EA.
/// Halves of an arc that begin straight, welded: at rest they are the arc of 2 rad and
/// radius 1/20 m. Both models have the arc among their shapes; the rest is motion left
/// after 3 s, with a drag of 40 1/s.
TEST(Joints, WeldHalvesThatBeginBentAgainstTheirNaturalShape) {
  for (const char* model : {"super_helix", "super_clothoid"}) {
    const std::string half =
        "length_m = 0.05\nelements = 5\nshape = \"along\"\ndarboux_along = [[0, 0, 20, "
        "0]]\ninitial = \"straight\"\n";
    Text text;
    text.model = "id = \"" + std::string(model) + "\"";
    text.integrator = "id = \"backward_euler\"\ndt_s = 0.02\n";
    text.material = "radius_m = 5e-5\nyoungs_modulus_pa = 3e9\n";
    text.strands = "[[strand]]\nname = \"upper\"\n" + half +
                   "[[strand]]\nname = \"lower\"\nroot = \"free\"\nposition_m = [0.05, "
                   "0, 0]\n" +
                   half;
    text.root = "motion = \"fixed\"\n";
    text.joints += "kind = \"weld\"\n";
    text.rest = "[effects.linear_drag]\nmass_damping_per_s = 40\n";
    World world(scene_of(text));
    ASSERT_EQ(world.advance(3), Status::ok) << world.failure();
    const Vec tip = point(world, 11);
    const Vec arc{0.05 * std::sin(2.0), 0, -0.05 * (1 - std::cos(2.0))};
    EXPECT_LE(norm(tip - arc), 1e-4 * 0.1) << model;
  }
}

TEST(Joints, ConnectPointsBySprings) {
  Text text;
  text.integrator = "id = \"esdirk43\"\ndt_s = 1e-3\n";
  text.material =
      "radius_m = 5e-3\nyoungs_modulus_pa = 1e12\n"
      "internal_friction_kg_m3_s = 0\n";
  text.strands =
      "[[strand]]\nlength_m = 0.1\nelements = 1\n[[strand]]\nlength_m = 0.1\nelements = "
      "1\nroot = \"free\"\nposition_m = [0.2, 0, 0]\n";
  text.root.clear();
  text.rest.clear();
  text.joints =
      "[[joints]]\na = [0, \"tip\"]\nb = [1, \"root\"]\nkind = \"spring\"\n"
      "stiffness_n_per_m = 20\ndamping_n_s_per_m = 0.02\nrest_length_m = 0.08\n";
  World world(scene_of(text));
  const double m = 1300 * std::numbers::pi * 25e-6 * 0.1, c = 0.02 / (2 * m),
               w = std::sqrt(20 / m - c * c);
  for (const double t : {0.05, 0.2}) {
    ASSERT_EQ(world.advance(t), Status::ok) << world.failure();
    const double stretch =
        0.02 * std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
    EXPECT_NEAR(point(world, 2).x, 0.18 + stretch, 1e-8);
    EXPECT_NEAR(point(world, 2).z, 0, 1e-12);
    const double speed = -0.02 * std::exp(-c * t) * (w + c * c / w) * std::sin(w * t);
    EXPECT_NEAR(world.support_loads().forces[0], -20 * stretch - 0.02 * speed, 1e-6);
  }
}

/// Every model holds a joint, or refuses it with its place. These hold more than balls.
TEST(Joints, HoldStrandsOfEveryModel) {
  std::string balls, turns;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    for (const std::string kind : {"ball", "weld", "hinge"}) {
      SCOPED_TRACE(std::string(model.id) + ", " + kind);
      Text text;
      text.model = "id = \"" + std::string(model.id) + "\"";
      text.joints +=
          "kind = \"" + kind + "\"\n" + (kind == "hinge" ? "axis = [0, 1, 0]\n" : "");
      if (const std::string why = refusal([&] { World{scene_of(text)}; }); !why.empty()) {
        std::printf("%s\n", why.c_str());
        EXPECT_NE(why.find("joined.toml:"), std::string::npos) << why;
        continue;
      }
      World world(scene_of(text));
      ASSERT_EQ(world.advance(0.05), Status::ok) << world.failure();
      EXPECT_LE(norm(point(world, 4) - point(world, 5)), 1e-9);
      if (kind != "hinge")
        (kind == "ball" ? balls : turns) += std::string(model.id) + " ";
    }
  }
  EXPECT_EQ(turns, "super_helix super_clothoid der corde xpbd_cosserat ");
  EXPECT_EQ(balls, turns + "mass_spring lifted_curls ");
}

/// Two clamped strands that lean against each other. By symmetry the joint at the top
/// carries a horizontal force alone, to rounding of weights of 5e-3 N.
TEST(Joints, MakeAnArchOfClampedStrands) {
  for (const char* model : {"articulated_chain", "super_helix", "der"}) {
    for (const char* kind : {"ball", "weld", "hinge"}) {
      SCOPED_TRACE(std::string(model) + ", " + kind);
      Text text;
      text.model = "id = \"" + std::string(model) + "\"";
      text.root.clear();
      const std::string strand = "[[strand]]\nlength_m = 0.1\nelements = 4\n";
      text.strands =
          strand + "root_tangent = [1, 0, 1]\n" + strand +
          "root_tangent = [-1, 0, 1]\nposition_m = [0.1414213562373095, 0, 0]\n";
      text.joints = "[[joints]]\na = [0, \"tip\"]\nb = [1, \"tip\"]\nkind = \"" +
                    std::string(kind) + "\"\n" +
                    (std::string(kind) == "hinge" ? "axis = [0, 1, 0]\n" : "");
      World world(scene_of(text));
      ASSERT_EQ(world.advance(0.05), Status::ok) << world.failure();
      EXPECT_LE(norm(point(world, 4) - point(world, 9)), 1e-9);
      const std::vector<double> force = world.support_loads().forces;
      EXPECT_GE(std::abs(force[0]), 1e-4);
      EXPECT_LE(std::max(std::abs(force[1]), std::abs(force[2])), 1e-10);
    }
  }
}

/// Three strands at one point: a third joint is redundant. The motion is that of two, to
/// rounding, and the forces have the least norm: they share the load.
TEST(Joints, MayBeRedundant) {
  Text text;
  text.strands +=
      "[[strand]]\nname = \"third\"\nroot = \"free\"\nlength_m = 0.1\nelements = "
      "4\nroot_tangent = [-1, 0, 0]\nposition_m = [0, 0, -0.1]\n";
  text.joints += "[[joints]]\na = [\"upper\", \"tip\"]\nb = [\"third\", \"root\"]\n";
  World two(scene_of(text));
  text.joints += "[[joints]]\na = [\"lower\", \"root\"]\nb = [\"third\", \"root\"]\n";
  World three(scene_of(text));
  ASSERT_EQ(two.advance(0.05), Status::ok) << two.failure();
  ASSERT_EQ(three.advance(0.05), Status::ok) << three.failure();
  EXPECT_EQ(two.stats().rank_deficiency, 0);
  EXPECT_EQ(three.stats().rank_deficiency, 3);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_LE(norm(point(two, i) - point(three, i)), 1e-10);
  }
  const std::vector<double> one = two.support_loads().forces,
                            all = three.support_loads().forces;
  // What acts on the third strand.
  EXPECT_NEAR(all[3] + all[6], one[3], 1e-9);
}

/// The columns of the series are those of the joints, and each strand is a line.
TEST(Joints, WriteTheirForcesAmongTheColumns) {
  const Scene scene = scene_of({});
  World world(scene);
  Readout readout(scene, world);
  ASSERT_EQ(world.advance(0.05), Status::ok) << world.failure();
  const Frame3d frame = readout.read(world);
  ASSERT_EQ(frame.series.size(), readout.series().size());
  const auto column =
      std::ranges::find(readout.series(), "force_joint_0_z_n", &Reading::name);
  ASSERT_NE(column, readout.series().end());
  // It carries the lower strand.
  EXPECT_GT(frame.series[std::size_t(column - readout.series().begin())], 0);
  EXPECT_EQ(readout.lines(), (std::vector{5, 5}));
}

/// A ring: a weld of both ends of one strand. It falls freely, and stays closed.
TEST(Joints, CloseARing) {
  Text text;
  text.strands =
      "[strand]\nroot = \"free\"\nlength_m = 0.6283185307179586\nelements = "
      "12\nshape = \"helix\"\ncurl_radius_m = 0.1\ncurl_pitch_m = 0\n";
  text.joints = "[[joints]]\na = [0, \"root\"]\nb = [0, \"tip\"]\nkind = \"weld\"\n";
  World world(scene_of(text));
  const Vec start = point(world, 0);
  ASSERT_EQ(world.advance(0.1), Status::ok) << world.failure();
  EXPECT_LE(norm(point(world, 0) - point(world, 12)), 1e-10);
  EXPECT_NEAR(point(world, 0).z - start.z, -9.81 * 0.1 * 0.1 / 2, 1e-4);
}

TEST(Joints, AreWrittenBack) {
  Text text;
  text.joints += "kind = \"hinge\"\naxis = [0, 1, 0]\n";
  const Scene scene = scene_of(text);
  const Scene again = parse_scene(scene_text(scene), "again.toml");
  World first(scene), second(again);
  EXPECT_EQ(first.support_loads().moments, second.support_loads().moments);
}

/// A snapshot continues as the run does, bit by bit.
TEST(Joints, ContinueFromASnapshot) {
  const Scene scene = scene_of({});
  World whole(scene), part(scene);
  ASSERT_EQ(whole.advance(0.02), Status::ok);
  part.restore(whole.snapshot());
  World other(scene);
  other.restore(whole.snapshot());
  ASSERT_EQ(part.advance(0.04), Status::ok);
  ASSERT_EQ(other.advance(0.04), Status::ok);
  EXPECT_EQ(part.positions(), other.positions());
}

std::string refused(const Text& text) {
  return refusal([&] { World{scene_of(text)}; });
}

TEST(Joints, AreRefusedInOneLineWithPlaceAndRemedy) {
  const auto with = [](const std::string& joints) {
    Text text;
    text.joints = joints;
    return text;
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(
      refused(with("[[joints]]\na = [\"uper\", \"tip\"]\nb = [1, \"root\"]\n")),
      "a joint of a strand 'uper' (joined.toml:32:5): use one of: 0, 1, lower, upper");
  EXPECT_EQ(refused(with("[[joints]]\na = [\"upper\"]\nb = [1, \"root\"]\n")),
            "a: expected a strand and a point (joined.toml:32:5): give a = [\"NAME\", "
            "\"tip\"], with the name or the number of a strand");
  EXPECT_EQ(refused(with("[[joints]]\na = [\"upper\", \"tip\"]\n")),
            "b of a joint without a strand and a point (joined.toml:31:1): give b = "
            "[\"NAME\", \"tip\"], with the name or the number of a strand");
  EXPECT_EQ(refused(with("[[joints]]\na = [0, 0.3]\nb = [1, \"root\"]\n")),
            "no point at 0.3 of strand 0 (joined.toml:32:5): give at = 0.25, the nearest "
            "end of an element, or other elements");
  const std::string ends =
      "[[joints]]\na = [\"upper\", \"tip\"]\nb = [\"lower\", \"root\"]\n";
  EXPECT_EQ(refused(with(ends + "kind = \"hinge\"\n")),
            "a hinge without an axis (joined.toml:34:8): give [joints] axis, such as [0, "
            "1, 0]");
  EXPECT_EQ(refused(with(ends + "axis = [0, 1, 0]\n")),
            "axis of a joint with kind = \"ball\" (joined.toml:34:8): leave it out, or "
            "give kind = \"hinge\"");
  EXPECT_EQ(refused(with(ends + "kind = \"spring\"\n")),
            "a spring without stiffness (joined.toml:34:8): give stiffness_n_per_m");
  EXPECT_EQ(refused(with("[[joints]]\na = [\"upper\", \"tip\"]\nb = [0, \"tip\"]\n")),
            "a joint of a point with itself (joined.toml:33:5): join two points");
  EXPECT_EQ(
      refused(with("[[joints]]\na = [\"upper\", 0.5]\nb = [1, \"root\"]\n")),
      "the points of a joint begin 0.05 m apart (joined.toml:31:1): move the strand "
      "of b by [0, 0, 0.05], or give shapes that meet");
  EXPECT_EQ(
      refused(with(ends + "[[joints]]\na = [1, 0]\nb = [0, 1]\nkind = \"weld\"\n")),
      "a second joint of the same points (joined.toml:34:1): leave out one of them");
  Text ring;
  ring.strands = "[strand]\nroot = \"free\"\nlength_m = 0.1\nelements = 4\n";
  ring.joints = "[[joints]]\na = [0, \"root\"]\nb = [0, \"tip\"]\nkind = \"weld\"\n";
  EXPECT_NE(refused(ring).find("the points of a joint begin 0.1 m apart (joined.toml:"),
            std::string::npos)
      << refused(ring);
  Text named;
  named.strands += "name = \"upper\"\n";
  EXPECT_NE(refused(named), "");
  Text planar;
  planar.model = "id = \"super_helix\"\nmodes = \"bend\"";
  planar.joints += "kind = \"weld\"\n";
  EXPECT_NE(refused(planar).find("needs a frame of the section"), std::string::npos)
      << refused(planar);
  Text clamped;
  clamped.joints = "[[joints]]\na = [0, \"root\"]\nb = [2, \"root\"]\n";
  clamped.strands += "[[strand]]\nlength_m = 0.1\nelements = 4\n";
  EXPECT_NE(refused(clamped).find("two points that cannot move"), std::string::npos)
      << refused(clamped);
  Text quasi_static;
  quasi_static.model = "id = \"der\"\ntwist = \"quasi_static\"";
  EXPECT_NE(refused(quasi_static).find("der with twist = \"dynamic\""), std::string::npos)
      << refused(quasi_static);
  Text rest;
  rest.top = "rest = \"inverse\"\n";
  EXPECT_NE(refused(rest).find("joints with rest = \"inverse\""), std::string::npos);
  Text constrained;
  constrained.model = "id = \"inextensible_strand\"";
  EXPECT_NE(refused(constrained).find("has constraints of its own"), std::string::npos)
      << refused(constrained);
  Text method;
  method.integrator = "id = \"xpbd\"";
  EXPECT_NE(refused(method).find("xpbd cannot drive super_helix with [joints]"),
            std::string::npos)
      << refused(method);
}

/// Two clamped strands in one line that a joint holds taut: they have no motion of first
/// order, and no step has a solution. `der` stretches.
TEST(Joints, RefuseTautStrands) {
  for (const char* model : {"super_helix", "super_clothoid", "der"}) {
    Text text;
    text.model = "id = \"" + std::string(model) + "\"";
    text.root = "motion = \"fixed\"\n";
    text.strands =
        "[[strand]]\nname = \"upper\"\nlength_m = 0.1\nelements = 4\n[[strand]]\nname = "
        "\"lower\"\nlength_m = 0.1\nelements = 4\nposition_m = [0.2, 0, 0]\n"
        "root_tangent = [-1, 0, 0]\n";
    text.joints = "[[joints]]\na = [\"upper\", \"tip\"]\nb = [\"lower\", \"tip\"]\n";
    const std::string why = refused(text);
    if (std::string(model) == "der") {
      EXPECT_EQ(why, "");
    } else {
      EXPECT_NE(why.find("joined strands that are taut"), std::string::npos) << why;
      EXPECT_NE(why.find("(joined.toml:"), std::string::npos) << why;
    }
  }
}

/// spin_rad_s turns two welded strands as one bar of length 2 L about its end: the energy
/// is m (2 L)^2 w^2/6 of the whole, by masses at points within 1/(2 n^2), and no wave of
/// bending takes any of it. Without gravity the tip turns on at 2 L w.
TEST(Joints, SpinTogether) {
  for (const char* model : {"super_helix", "der"}) {
    Text text;
    text.model = "id = \"" + std::string(model) + "\"";
    text.root = "motion = \"free\"\nspin_rad_s = [0, 0, 2]\n";
    text.rest.clear();
    text.strands =
        "[[strand]]\nname = \"upper\"\nlength_m = 0.1\nelements = 4\n[[strand]]\nname = "
        "\"lower\"\nlength_m = 0.1\nelements = 4\nposition_m = [0.1, 0, 0]\n";
    text.joints += "kind = \"weld\"\n";
    World world(scene_of(text));
    const double mass = 1300 * std::numbers::pi * 1e-6 * 0.2;
    EXPECT_NEAR(world.energies().kinetic / (mass * 0.04 * 4 / 6), 1, 0.02) << model;
    const Vec tip = load3(&world.velocities()[3 * 9]);
    EXPECT_NEAR(norm(tip - Vec{0, 0.4, 0}), 0, 1e-9) << model;
    const double elastic = world.energies().elastic;
    ASSERT_EQ(world.advance(0.01), Status::ok) << world.failure();
    // Inertia stretches and bends the bar by far less than a jolt would.
    EXPECT_LE(world.energies().elastic - elastic, 1e-3 * world.energies().kinetic)
        << model;
  }
}

}  // namespace tress::test_joints
