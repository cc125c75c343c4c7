// Bodies that move by keyframes of their own: as the head by the same ones, and as a belt
// that carries a strand.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "contract/input_error.h"
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
/// contact, 1e-6 m (TurningBody in tests/models/effects).
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

TEST(MovingBody, RefusesKeyframesThatItDoesNotFollow) {
  const struct {
    const char *keys, *reason;
  } bad[] = {
      {"poses = [[0, 0, 0, 0, 0, 0, 0]]", "does not follow them"},
      {"keyframes = [[0, 0, 0, 0, 0]]", "does not follow them"},
      {"moves = \"keyframes\"\nkeyframes = [[1, 0, 0, 0, 0], [0, 0, 0, 0, 0]]",
       "not in order"},
      {"moves = \"keyframes\"\naxis = [0, 0, 0]\nkeyframes = [[0, 0, 0, 0, 0], [1, "
       "0, 0, 0, 0]]",
       "axis"}};
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
