#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "contract/input_error.h"
#include "experiments/stability_limit/stability_limit.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"

namespace tress::test_scene_limits {

using namespace experiments;
using namespace experiments::stability_limit;

using testing::HasSubstr;

class SceneLimit : public testing::Test {
 protected:
  SceneLimit() : folder_(std::filesystem::path(testing::TempDir()) / "scene_limits") {
    std::filesystem::create_directories(folder_);
  }

  std::string file(const std::string& name, const std::string& text) const {
    const auto path = folder_ / name;
    std::ofstream(path) << text;
    return path.string();
  }

  /// The rows of one scene by these methods, run.
  static std::vector<Row> rows(const std::string& scene,
                               const std::vector<std::string>& integrators,
                               const SceneLimits& how) {
    CommandLine line;
    line.integrators = integrators;
    std::vector<Row> all;
    for (const Case& work : scene_cases(line, {scene}, how)) {
      Row row = work.identity;
      work.run(row, Deadline(600));
      all.push_back(row);
    }
    return all;
  }

 private:
  std::filesystem::path folder_;
};

// A string of springs that nothing damps: its highest frequency omega bounds every
// explicit method, velocity_verlet by dt omega <= 2, rk4 by 2 sqrt(2).
constexpr const char* springs = R"(
title = "springs"
duration_s = 0.05

[model]
id = "mass_spring"

[integrator]
id = "rk4"

[material]
name = "custom"
radius_m = 1e-4
youngs_modulus_pa = 1e6
poisson_ratio = 0.3
density_kg_m3 = 1300
internal_friction_kg_m3_s = 0

[strand]
elements = 4
length_m = 0.05

[effects.gravity]
)";

TEST_F(SceneLimit, OfExplicitMethodsIsThatOfTheHighestFrequency) {
  const SceneLimits how{{.coarsest = 1e-3, .finest = 1e-7, .depth = 3}, 1e9, 0.05, 1, 1};
  const auto found = rows(file("springs.toml", springs), {"rk4", "velocity_verlet"}, how);
  ASSERT_EQ(found.size(), 2u);
  double rk4 = 0, verlet = 0;
  for (const Row& row : found) {
    ASSERT_TRUE(row.ok()) << row.text("reason");
    (row.text("integrator") == "rk4" ? rk4 : verlet) = row.number("dt_max_s");
  }
  // Each is known to the resolution of the search, 5 %.
  EXPECT_NEAR(std::log(rk4 / verlet), std::log(std::sqrt(2.0)), 2 * std::log(1.05));
}

/// Whether steps of `dt` keep the guard silent to `t_end`, without being divided.
bool holds(const std::string& text, double dt, double t_end) {
  Scene scene = parse_scene(text, "scene.toml");
  scene.options.step = dt;
  scene.guard = true;
  World world(scene);
  return world.advance(t_end) == Status::ok && world.stats().rejected == 0;
}

// A limit that is told is true for longer than the scene lasts.
TEST_F(SceneLimit, HoldsOverFiveTimesTheScene) {
  const SceneLimits how{{.coarsest = 1e-3, .finest = 1e-7, .depth = 3}, 1e9, 0.05, 1, 1};
  const auto found = rows(file("springs.toml", springs), {"rk4"}, how);
  ASSERT_EQ(found.size(), 1u);
  const Row& row = found.front();
  const double dt = row.number("dt_max_s"), t_end = row.number("t_end_s");
  EXPECT_NEAR(t_end, 0.25, 1e-9);  // 5 times 0.05 s
  EXPECT_TRUE(holds(springs, 0.9 * dt, t_end));
  EXPECT_FALSE(holds(springs, 1.5 * dt, t_end));
  EXPECT_TRUE(row.has("at_1_5"));
  EXPECT_NE(row.text("at_1_5"), "stable");

  const auto lines = stability_answer(found);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0],
              HasSubstr("springs, mass_spring: rk4 (jacobian exact): stable up to "));
  EXPECT_THAT(lines[0], HasSubstr(", unstable at 1.5 times that ("));
  EXPECT_THAT(lines[0], HasSubstr("; judged over 250 ms; "));
}

TEST_F(SceneLimit, OfAMethodThatTheModelCannotTakeIsARefusal) {
  const SceneLimits how{{.coarsest = 1e-3, .finest = 1e-4}, 1e7, 0.05, 1, 1};
  std::string helix = springs;
  helix.replace(helix.find("mass_spring"), 11, "super_helix");
  const auto found = rows(file("helix.toml", helix), {"xpbd"}, how);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().status(), "refused");
  EXPECT_THAT(std::string(found.front().text("reason")), HasSubstr("xpbd"));
  EXPECT_EQ(
      stability_answer(found),
      std::vector<std::string>{
          "helix, super_helix: not driven by xpbd (jacobian exact) (--list says why)"});
}

TEST_F(SceneLimit, EndsWithItsWork) {
  const SceneLimits how{{.coarsest = 1e-3, .finest = 1e-7, .depth = 3}, 2e3, 0.05, 1, 1};
  const auto found = rows(file("springs.toml", springs), {"rk4"}, how);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().status(), "gave_up");
}

// What --quick leaves of the methods is the same for the user's scene and for our hair.
TEST_F(SceneLimit, OfAQuickTableAreOfTheMethodsOfTheGrid) {
  CommandLine line;
  line.quick = true;
  const std::string scene = file("springs.toml", springs);
  std::set<std::string> of_scene, of_grid;
  for (const Case& work : scene_cases(line, {scene}, {{}, 1e6, 0.05, 1, 1})) {
    of_scene.emplace(work.identity.text("integrator"));
  }
  for (const StabilityCase& c :
       stability_cases(line, Settings(line, stability_settings()))) {
    of_grid.emplace(c.integrator);
  }
  EXPECT_EQ(of_scene, of_grid);
  EXPECT_TRUE(of_scene.contains("backward_euler"));
  EXPECT_FALSE(of_scene.contains("newmark"));
}

TEST_F(SceneLimit, DoesNotTakeWhatTheSceneSays) {
  CommandLine line;
  line.models = {"der"};
  const std::string scene = file("springs.toml", springs);
  EXPECT_THROW(scene_cases(line, {scene}, {{}, 1e6, 0.05, 1, 1}), InputError);
  line.models.clear();
  line.elements = {5};
  EXPECT_THROW(scene_cases(line, {scene}, {{}, 1e6, 0.05, 1, 1}), InputError);
  EXPECT_THROW(scene_cases({}, {scene, scene}, {{}, 1e6, 0.05, 1, 1}), InputError);
}

}  // namespace tress::test_scene_limits
