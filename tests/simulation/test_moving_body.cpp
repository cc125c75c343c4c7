// Bodies that move by keyframes of their own: as the head by the same ones, as a belt
// that carries a strand, and past a strand in less than a step.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "contract/input_error.h"
#include "models/passages/body_passage.h"
#include "simulation/head/head_run.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/world.h"
#include "tests/support/refusal.h"

namespace tress::test_moving_body {

using namespace simulation;
using testing_support::refusal;

std::string text_of(const std::string& model, const std::string& method,
                    const std::string& rest) {
  return "title = \"body\"\nduration_s = 1\n[model]\nid = \"" + model +
         "\"\n[integrator]\n" + method +
         "\n[material]\nname = \"custom\"\nradius_m = 1e-4\nyoungs_modulus_pa = 3e9\n"
         "poisson_ratio = 0.45\ndensity_kg_m3 = 1300\n" +
         rest;
}
Scene scene_of(const std::string& text) { return parse_scene(text, "body.toml"); }

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// A sphere that pushes a hanging strand: carried by the head, and with the head's
/// keyframes as its own. The two motions differ by roundings, which 100 steps amplify to
/// less than 1e-9 m.
TEST(MovingBody, MovesAsTheHeadByTheSameKeyframes) {
  const std::string keyframes =
      "keyframes = [[0, 0, 0, 0, 0], [0.05, 0, 0.01, 0, 0.3], [0.2, 0.01, 0, 0, 0]]\n"
      "axis = [0, 0, 1]\ncentre_m = [0, 0, 0]\n";
  for (const char* model : {"super_helix", "der", "articulated_chain", "corde"}) {
    SCOPED_TRACE(model);
    const auto end = [&](const std::string& moves) {
      World world(scene_of(text_of(
          model, "id = \"backward_euler\"\ndt_s = 1e-3",
          "[strand]\nlength_m = 0.1\nelements = 6\nposition_m = [0.052, 0, 0.05]\n"
          "root_tangent = [0, 0, -1]\n[root]\nmotion = \"keyframes\"\n" +
              keyframes +
              "[effects.gravity]\n[[effects.body]]\nshape = \"sphere\"\nradius_m = "
              "0.05\n" +
              moves)));
      EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
      return world.positions();
    };
    const auto with_head = end("moves = \"head\"\n");
    EXPECT_LE(apart(with_head, end("moves = \"keyframes\"\n" + keyframes)), 1e-9);
    EXPECT_GE(apart(with_head, end("moves = \"fixed\"\n")), 1e-4);
  }
}

/// A belt carries a strand that sticks to it: the belt's acceleration is 1.4 m/s^2 at
/// most, friction bears 4.9. The strand keeps its place on the belt to the tolerance of
/// contact, 1e-6 m (DrivenBody in tests/models/effects).
TEST(MovingBody, CarriesAStrandThatSticks) {
  for (const char* model : {"der", "super_helix", "mass_spring"}) {
    SCOPED_TRACE(model);
    World world(scene_of(text_of(
        model, "id = \"backward_euler\"\ndt_s = 2e-3",
        "[strand]\nlength_m = 0.1\nelements = 4\nposition_m = [0, 0, 1e-4]\n[root]\n"
        "motion = \"free\"\n[effects.gravity]\n[[effects.body]]\nshape = \"plane\"\n"
        "friction_law = \"exact\"\nnormal = \"rigid\"\nfriction = 0.5\n"
        "strand_radius_m = 1e-4\nmoves = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], "
        "[0.5, "
        "0, 0.05, 0, 0]]\n")));
    const std::vector<double> before = world.positions();
    ASSERT_EQ(world.advance(0.5), Status::ok) << world.failure();
    const std::vector<double>& after = world.positions();
    for (std::size_t i = 0; i < after.size(); ++i) {
      EXPECT_NEAR(after[i] - before[i], i % 3 == 1 ? 0.05 : 0, 1e-6) << i;
    }
  }
}

/// Rows of a file are those of a list, with blanks or commas, a header and comments; and
/// poses that turn about z alone are keyframes about z.
TEST(MovingBody, ReadsItsRowsFromAFile) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("tress_rows_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  write("poses.csv",
        "\xEF\xBB\xBF"
        "t,x,y,z,about_x,about_y,about_z\n# a comment\n0,0,0,0,0,0,0\n\n0.1 0.01 0 0 0 0 "
        "+0.3\r\n");
  const auto end = [&](const std::string& moves) {
    World world(parse_scene(
        text_of("der", "id = \"backward_euler\"\ndt_s = 1e-3",
                "[strand]\nlength_m = 0.1\nelements = 6\nposition_m = [0.052, 0, 0.05]\n"
                "root_tangent = [0, 0, -1]\n[effects.gravity]\n[[effects.body]]\n"
                "shape = \"sphere\"\nradius_m = 0.05\n" +
                    moves),
        (folder / "scene.toml").string()));
    EXPECT_EQ(world.advance(0.1), Status::ok) << world.failure();
    return world.positions();
  };
  const auto of_file = end("moves = \"poses\"\nposes = \"poses.csv\"\n");
  EXPECT_EQ(of_file,
            end("moves = \"poses\"\nposes = [[0, 0, 0, 0, 0, 0, 0], [0.1, 0.01, 0, "
                "0, 0, 0, 0.3]]\n"));
  EXPECT_LE(
      apart(of_file, end("moves = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], [0.1, "
                         "0.01, 0, 0, 0.3]]\n")),
      1e-9);
  const struct {
    const char *text, *reason;
  } bad[] = {{"0,0,0,0,0,0,0\n1,0,0\n", "a row of 3 numbers where poses has 7"},
             {"0,0,0,0,0,0,0\n1,0,0,x,0,0,0\n", "'x' is not a number"},
             {"t,x\nt,x\n", "'t' is not a number"},
             {"0,0,0,0,0,0,O\n", "'O' is not a number"},
             {"0,0,0,0,0,,0\n", "a cell is empty"},
             {"0,0,0,0,0,0,0,\n", "a cell is empty"},
             {"0,0,0,0,0,0,nan\n", "'nan' is not a number"},
             {"# nothing\n", "no row of poses"}};
  for (const auto& [text, reason] : bad) {
    write("poses.csv", text);
    const std::string said =
        refusal([&] { end("moves = \"poses\"\nposes = \"poses.csv\"\n"); });
    EXPECT_NE(said.find(reason), std::string::npos) << text << ": " << said;
  }
  EXPECT_NE(
      refusal([&] { end("moves = \"poses\"\nposes = \"none.csv\"\n"); }).find("none.csv"),
      std::string::npos);
  std::filesystem::remove_all(folder);
}

/// A vertical capsule of radius 0.5 mm that passes the lower half of a hanging hair:
/// 0.4 m in 0.2 s from 0.1 m beside it, at 3.75 m/s at most (keyframes are a quintic,
/// with 15/8 of the mean speed). It is at the hair at t = 0.0719 s.
Scene crossed(const std::string& model, const std::string& dt, const std::string& law) {
  return scene_of(text_of(
      model, "id = \"backward_euler\"\ndt_s = " + dt,
      "[strand]\nlength_m = 0.1\nelements = 6\nroot_tangent = [0, 0, -1]\n"
      "[effects.gravity]\n[[effects.body]]\nshape = \"capsule\"\nradius_m = 5e-4\n"
      "length_m = 0.1\ncentre_m = [-0.1, 0, -0.1]\nmoves = \"keyframes\"\n"
      "keyframes = [[0, 0, 0, 0, 0], [0.2, 0.4, 0, 0, 0]]\n" +
          law));
}
constexpr double capsule = 5e-4 + 40e-6, fastest = 3.75;  // m, with the strand's; m/s
const char* const stiff = "stiffness_n_m2 = 1e4\n";
const char* const rigid = "friction_law = \"exact\"\nnormal = \"rigid\"\n";

/// The hair stands still until the capsule is within its radius of it. At 10 ms no end of
/// a step sees the capsule, which moves by 30 mm and more per step there. The path goes
/// through the axis to within the gaps of its samples, an eighth of a radius. The step
/// named is that in which the path, of at most 37.5 mm in 10 ms, is a radius.
TEST(MovingBody, ReportsAThinBodyThatPassesWithinAStep) {
  for (const char* law : {stiff, rigid}) {
    SCOPED_TRACE(law);
    World coarse(crossed("der", "0.01", law));
    coarse.take_depth();
    ASSERT_EQ(coarse.advance(0.1), Status::ok) << coarse.failure();
    const auto passed = coarse.passed();
    ASSERT_TRUE(passed);
    EXPECT_EQ(passed->strand, 0U);
    EXPECT_EQ(passed->contact.body, 0U);
    EXPECT_NEAR(passed->contact.t, 0.08, 1e-9);
    EXPECT_NEAR(passed->contact.depth, capsule - 5e-4 / 16, 5e-4 / 16);
    EXPECT_EQ(coarse.take_depth(), passed->contact.depth);
    EXPECT_GE(passed->contact.needed, 5e-4 / fastest);
    EXPECT_LE(passed->contact.needed, 5e-4 / fastest * 1.5);
    // The work of impacts of a rigid body that moves is not in the account of the guard.
    Scene short_steps = crossed("der", "1e-4", law);
    short_steps.guard = law == stiff;
    World fine(short_steps);
    fine.take_depth();
    ASSERT_EQ(fine.advance(0.08), Status::ok) << fine.failure();
    EXPECT_FALSE(fine.passed());
    EXPECT_GT(fine.positions()[3 * 6], 0.01);  // the capsule carries it on
  }
}

/// The same in SIMD lanes, and as systems of their own.
TEST(MovingBody, ReportsAPassageInABatch) {
  const struct {
    const char *model, *law;
    bool lanes;
  } batches[] = {{"super_helix", "", true}, {"der", rigid, false}};
  for (const auto& [model, law, lanes] : batches) {
    SCOPED_TRACE(model);
    for (const bool far : {false, true}) {
      const std::string away = far ? "\n[[effects.body]]\nshape = \"plane\"\n"
                                     "centre_m = [0, 0, -1]\n"
                                   : std::string(law);
      Scene scene = crossed(model, "0.01", away);
      if (far) scene.effects.erase(scene.effects.begin());
      scene.strands.assign(5, scene.strands.front());
      HeadRun run(make_head(scene, {models::HeadNumber::float64, 4}, 2), 2);
      ASSERT_TRUE(far || run.lanes() == lanes);
      for (int i = 0; i < 10; ++i) run.step(0.01 * i, 0.01);
      ASSERT_EQ(run.passed().has_value(), !far);
      if (far) continue;
      EXPECT_EQ(run.passed()->strand, 0U);
      EXPECT_NEAR(run.passed()->contact.t, 0.08, 1e-9);
    }
  }
}

/// A hair that falls on a thick body, and one that falls on a plane so fast that every
/// step is longer than the hair.
TEST(MovingBody, ReportsNoPassageOfThickBodies) {
  const auto fall = [](const std::string& body, const std::string& dt, double end) {
    World world(scene_of(text_of(
        "der", "id = \"backward_euler\"\ndt_s = " + dt,
        "[strand]\nlength_m = 0.05\nelements = 6\nposition_m = [-0.025, 0, 0.03]\n"
        "[root]\nmotion = \"free\"\n[effects.gravity]\n[[effects.body]]\n" +
            body)));
    world.take_depth();
    EXPECT_EQ(world.advance(end), Status::ok) << world.failure();
    EXPECT_FALSE(world.passed());
    return world.take_depth();
  };
  EXPECT_GT(fall("shape = \"sphere\"\nradius_m = 0.02\nfriction = 0\n", "5e-3", 0.2), 0);
  EXPECT_GT(fall("shape = \"plane\"\ncentre_m = [0, 0, -1]\n", "0.02", 0.5), 0);
}

/// A path beside the axis of a capsule is as deep as its place nearest to the axis, to
/// the gaps of its samples: a place off by an eighth of a radius is lower by less than
/// (r/8)^2/(2 y). Nothing passes from one side to the same side, nor from within.
TEST(MovingBody, FindsTheDepthOfAPath) {
  const Scene scene = crossed("der", "0.01", "");
  const auto body = make_effects(scene).at(0);
  const auto depth = [&](const Vec& from, const Vec& to) {
    const Vec centre{-0.1, 0, -0.1};
    const Vec a = from + centre, b = to + centre;
    const double x[] = {a.x, a.y, a.z}, y[] = {b.x, b.y, b.z};
    return models::passage(*models::body_of(*body), {0, 0, x, y}).depth;
  };
  const double beside = 3e-4, r = 5e-4;
  EXPECT_NEAR(depth({-5e-3, beside, 0}, {7e-3, beside, 0}), capsule - beside,
              r * r / 64 / (2 * beside));
  EXPECT_EQ(depth({-5e-3, capsule, 0}, {7e-3, capsule, 0}), 0);
  EXPECT_EQ(depth({-5e-3, 0, 0}, {-1e-3, 0, 0}), 0);
  EXPECT_EQ(depth({-5e-3, 0, 0}, {5e-4, 0, 0}), 0);
}

TEST(MovingBody, RefusesKeyframesThatItDoesNotFollow) {
  const struct {
    const char *keys, *reason;
  } bad[] = {
      {"poses = [[0, 0, 0, 0, 0, 0, 0]]", "poses does nothing with moves = \"fixed\""},
      {"keyframes = [[0, 0, 0, 0, 0]]", "leave it out, or choose moves = keyframes"},
      {"moves = \"keyframes\"\nkeyframes = [[1, 0, 0, 0, 0], [0, 0, 0, 0, 0]]",
       "keyframe 2 at 0 s is not later than keyframe 1 at 1 s"},
      {"moves = \"keyframes\"\naxis = [0, 0, 0]\nkeyframes = [[0, 0, 0, 0, 0], [1, "
       "0, 0, 0, 0]]",
       "axis has no direction (body.toml"}};
  for (const auto& [keys, reason] : bad) {
    const std::string said = refusal([&] {
      const Scene scene =
          scene_of(text_of("der", "id = \"backward_euler\"",
                           std::string("[strand]\n[[effects.body]]\n") + keys + "\n"));
      make_effects(scene);
    });
    EXPECT_NE(said.find(reason), std::string::npos) << keys << ": " << said;
  }
}

}  // namespace tress::test_moving_body
