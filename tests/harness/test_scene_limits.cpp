#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
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

/// Whether whole steps of `dt` keep the guard silent to `t_end`, without being divided.
/// In 16 parts, as in the search, so that times are rounded in the same way.
bool holds(const std::string& text, double dt, double t_end) {
  Scene scene = parse_scene(text, "scene.toml");
  scene.options.step = dt;
  scene.guard = true;
  World world(scene);
  const double steps = std::ceil(t_end / dt - 1e-9), parts = std::min(steps, 16.0);
  for (double part = 1; part <= parts; ++part) {
    const double t = std::round(steps * part / parts) * dt;
    if (world.advance(t) != Status::ok || world.stats().rejected > 0) return false;
  }
  return true;
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
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0],
              HasSubstr("springs, mass_spring: rk4 (jacobian exact): stable at every one "
                        "of " +
                        std::string(row.text("stable_runs")) + " steps tried from "));
  EXPECT_THAT(lines[0], HasSubstr(", unstable at 1.5 times that ("));
  EXPECT_THAT(lines[0], HasSubstr("; judged over 250 ms at the longest step; "));
  EXPECT_THAT(lines[1], HasSubstr("may be unstable"));
}

// Stability is not monotone for a string of springs that falls on a sphere: some steps
// shorter than a bisected limit are unstable. Each step that the answer counts holds.
TEST_F(SceneLimit, HoldsAtShorterStepsToo) {
  std::string text = springs;
  const auto put = [&](std::string_view old, std::string_view by) {
    text.replace(text.find(old), old.size(), by);
  };
  put("rk4", "linearly_implicit_euler");
  put("duration_s = 0.05", "duration_s = 0.5");
  put("radius_m = 1e-4", "radius_m = 5e-5");
  put("poisson_ratio = 0.3", "shear_modulus_pa = 1e9");
  put("youngs_modulus_pa = 1e6", "youngs_modulus_pa = 3e9");
  put("internal_friction_kg_m3_s = 0", "internal_friction_kg_m3_s = 1e-12");
  put("elements = 4", "elements = 10");
  put("length_m = 0.05", "length_m = 0.1\nroot_tangent = [1, 0, 0]\nnormal = [0, 1, 0]");
  text += R"(
[effects.linear_drag]
drag_kg_m_s = 2e-05

[effects.body]
shape = "sphere"
radius_m = 0.05
centre_m = [0.03, 0, -0.07]
)";
  const SceneLimits how{{.depth = 10}, 3e6, 0.5, 1, 1};
  const auto found = rows(file("contact.toml", text), {"linearly_implicit_euler"}, how);
  ASSERT_EQ(found.size(), 1u);
  const double dt = found.front().number("dt_max_s");
  const double t_end = found.front().number("t_end_s");
  EXPECT_DOUBLE_EQ(t_end, 2.5);
  for (const double part : {1.0, 0.99, 0.95, 0.9, 0.84, 0.8, 0.7}) {
    EXPECT_TRUE(holds(text, part * dt, t_end)) << part << " of " << dt;
  }
}

// Each method has a formulation of supports, which need not be that of the scene.
TEST_F(SceneLimit, DrivesSupportsInTheFormulationOfEachMethod) {
  std::string text = springs;
  const auto put = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  put("id = \"mass_spring\"", "id = \"der\"");
  put("id = \"rk4\"", "id = \"tr_bdf2\"");
  put("[strand]", "[[supports]]\nat = 0.5\n[strand]");
  const SceneLimits how{{.coarsest = 1e-2, .depth = 2}, 1e6, 0.05, 1, 1};
  const std::string scene = file("held.toml", text);
  for (const Row& row :
       rows(scene, {"backward_euler", "bdf2", "tr_bdf2", "generalized_alpha", "esdirk43"},
            how)) {
    EXPECT_EQ(row.status(), "ok") << row.text("integrator") << ": " << row.text("reason");
    EXPECT_GT(row.number("dt_max_s"), 1e-3) << row.text("integrator");
  }
}

// However little work there is: a limit that is told was run at the steps just below it,
// and a row without these runs is no result.
TEST_F(SceneLimit, IsInconclusiveWithoutTheStepsBelow) {
  const std::string scene = file("springs.toml", springs);
  int limits = 0, inconclusive = 0;
  for (double work = 1e3; work < 1e7; work *= 1.3) {
    const SceneLimits how{
        {.coarsest = 1e-3, .finest = 1e-7, .depth = 3}, work, 0.05, 1, 1};
    const auto found = rows(scene, {"rk4"}, how);
    ASSERT_EQ(found.size(), 1u);
    const Row& row = found.front();
    if (row.status() == "inconclusive") {
      ++inconclusive;
      EXPECT_FALSE(row.has("dt_max_s"));
      EXPECT_THAT(stability_answer(found).front(),
                  HasSubstr("rk4 (jacobian exact): inconclusive: the work of a row was "
                            "used up "));
    } else if (row.has("dt_max_s")) {
      ++limits;
      EXPECT_LE(row.number("dt_finest_s"), 0.7 * row.number("dt_max_s")) << work;
      EXPECT_GE(row.number("stable_runs"), 5) << work;
    }
  }
  EXPECT_GT(limits, 0);
  EXPECT_GT(inconclusive, 0);
}

// Fewer than ten steps show no growth: longer ones than a tenth of the longest run, five
// times the scene, are not tried.
TEST_F(SceneLimit, IsAtMostATenthOfTheRun) {
  std::string text = springs;
  text.replace(text.find("duration_s = 0.05"), 17, "duration_s = 1e-3");
  const SceneLimits how{{.depth = 3}, 1e7, 0.5, 1, 1};
  const auto found = rows(file("short.toml", text), {"backward_euler"}, how);
  ASSERT_EQ(found.size(), 1u);
  const Row& row = found.front();
  ASSERT_TRUE(row.ok()) << row.text("reason");
  EXPECT_DOUBLE_EQ(row.number("dt_max_s"), 5e-4);
  EXPECT_EQ(row.text("limited_by"), "cap");
  EXPECT_THAT(stability_answer(found).front(),
              HasSubstr(" to 500 us, the longest that was tried; judged over 5 ms at "));
}

TEST(StepSearchOfSettings, NeedsAStepBetweenItsBounds) {
  const auto search = [](const char* key, const char* value) {
    CommandLine line;
    line.set = {{key, value}};
    return step_search(Settings(line, stability_settings()).experiment(), 1e-6, 30);
  };
  EXPECT_EQ(search("floor_s", "0.1").finest, 0.1);
  EXPECT_THROW(search("floor_s", "1"), InputError);
  EXPECT_THROW(search("cap_s", "1e-9"), InputError);
  // Of a scene whose drive needs shorter steps than all of them, one step is left.
  const StepSearch one = up_to(0.01, search("floor_s", "0.1"));
  EXPECT_EQ(one.coarsest, 0.01);
  EXPECT_EQ(one.finest, 0.01);
}

/// The sentence about a row of these columns.
std::string sentence(double dt_max, double finest, int runs, int stable, bool done,
                     std::string_view limited_by) {
  Row row;
  row.set("scene", "s").set("model", "m").set("integrator", "i").set("t_end_s", 0.5);
  row.set("dt_max_s", dt_max).set("dt_finest_s", finest).set("runs", runs);
  row.set("stable_runs", stable).set("search_done", done);
  row.set("limited_by", limited_by);
  return stability_answer({row}).front();
}

TEST(LimitInWords, SaysNoMoreThanWasTried) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sentence(0.1, 0.1, 1, 1, true, "cap"),
            "s, m: i: stable at 100 ms, the only step tried; judged over 500 ms");
  EXPECT_EQ(sentence(0.1, 0.02, 4, 4, false, "cap"),
            "s, m: i: stable at every one of 4 steps tried from 20 ms to 100 ms, the "
            "longest that was tried; shorter steps were not checked; judged over 500 ms "
            "at the longest step");
  EXPECT_EQ(sentence(0.003, 0.0003, 15, 8, true, "energy"),
            "s, m: i: stable at every one of 8 steps tried from 300 us to 3 ms; judged "
            "over 500 ms at the longest step");
  EXPECT_EQ(sentence(none, 0.05, 2, 0, false, "energy"),
            "s, m: i: no stable step found in the work given (2 runs, down to 50 ms): "
            "raise it by --set row_work=X");
}

/// The sentence about a row without a result.
std::string failed(std::string_view study, std::string_view status,
                   std::string_view reason) {
  Row row;
  row.set("study", study).set("scene", "s").set("model", "m").set("integrator", "i");
  row.failed(status, reason);
  return stability_answer({row}).front();
}

// A process that was killed has no runs to tell of, and needs time, not work.
TEST(LimitInWords, SaysWhatEndedARowEarly) {
  EXPECT_EQ(failed("file", "timeout", "killed after 60 s"),
            "s, m: i: inconclusive: killed after 60 s: raise it by --timeout S");
  EXPECT_EQ(failed("tolerance", "timeout", "killed after 60 s"),
            "s, m: i with a tolerance: inconclusive: killed after 60 s: raise it by "
            "--timeout S");
  EXPECT_EQ(failed("file", "crashed", "signal 11"), "s, m: i: no answer: signal 11");
  EXPECT_EQ(failed("tolerance", "inconclusive", "work used up"),
            "s, m: i with a tolerance: inconclusive: work used up: raise it by --set "
            "row_work=X");
}

TEST_F(SceneLimit, OfAMethodThatTheModelCannotTakeIsARefusal) {
  const SceneLimits how{{.coarsest = 1e-3, .finest = 1e-4}, 1e7, 0.05, 1, 1};
  std::string helix = springs;
  helix.replace(helix.find("mass_spring"), 11, "super_helix");
  const auto found = rows(file("helix.toml", helix), {"xpbd"}, how);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().status(), "refused");
  EXPECT_THAT(std::string(found.front().text("reason")), HasSubstr("xpbd"));
  EXPECT_EQ(stability_answer(found),
            std::vector<std::string>{"helix, super_helix: not driven by xpbd (jacobian "
                                     "exact) (--list prints the reason)"});
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
