#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "experiments/stability_limit/stability_limit.h"

namespace tress::test_tolerance_limits {

using namespace experiments;
using namespace experiments::stability_limit;

/// A ladder of which the tolerances in (unstable_from, unstable_to) are unstable and
/// those below `finished` use up the work.
Row found(double unstable_from, double unstable_to, double finished) {
  Row row;
  find_tolerances(
      [&](double tolerance) -> std::optional<ToleranceRun> {
        if (tolerance < finished) return {};
        StabilityRun run;
        if (tolerance > unstable_from && tolerance < unstable_to) {
          run.broken = Broken::energy;
        }
        run.stats.steps = std::lround(10 / tolerance);
        return ToleranceRun{run, 100 / tolerance};
      },
      row);
  return row;
}

TEST(ToleranceLimit, IsTheLoosestWithNothingUnstableBelow) {
  const Row all = found(1, 1, 0);
  EXPECT_TRUE(all.ok());
  EXPECT_EQ(all.number("tolerance_loosest"), 1e-1);
  EXPECT_EQ(all.number("tolerance_tightest"), 1e-5);
  EXPECT_EQ(all.text("limited_by"), "cap");
  EXPECT_EQ(all.text("search_done"), "true");
  EXPECT_EQ(all.number("steps_usual"), 1e4);
  EXPECT_EQ(all.number("work_usual"), 1e5);

  const Row loose = found(5e-3, 1, 0);
  EXPECT_EQ(loose.number("tolerance_loosest"), 1e-3);
  EXPECT_EQ(loose.text("limited_by"), "energy");

  // Stable above an unstable one: that does not count.
  const Row between = found(5e-3, 5e-2, 0);
  EXPECT_EQ(between.number("tolerance_loosest"), 1e-3);
}

TEST(ToleranceLimit, EndsWithItsWork) {
  const Row some = found(1, 1, 5e-3);
  EXPECT_TRUE(some.ok());
  EXPECT_EQ(some.number("tolerance_loosest"), 1e-1);
  EXPECT_EQ(some.number("tolerance_tightest"), 1e-2);
  EXPECT_EQ(some.text("search_done"), "false");
  EXPECT_FALSE(some.has("steps_usual"));
  EXPECT_EQ(found(1, 1, 1).status(), "gave_up");
}

TEST(ToleranceLimit, FailsWhereTheTightestIsUnstable) {
  EXPECT_EQ(found(0, 1, 0).status(), "unstable");
  EXPECT_EQ(found(0, 5e-3, 0).status(), "unstable");  // though 1e-1 and 1e-2 are not
}

std::vector<Row> run(const std::vector<Case>& cases) {
  std::vector<Row> all;
  for (const Case& work : cases) {
    Row row = work.identity;
    work.run(row, Deadline(600));
    all.push_back(row);
  }
  return all;
}

// With constraints too, which error control holds by projection.
TEST(ToleranceLimit, OfOurHair) {
  CommandLine line;
  line.quick = true;
  line.models = {"super_helix", "inextensible_strand"};
  line.elements = {2};
  line.set = {{"scene", "release"}, {"study", "tolerance"}};
  const Settings settings(line, stability_settings());
  EXPECT_TRUE(stability_cases(line, settings).empty());
  EXPECT_TRUE(nodal_cases(line, settings).empty());
  const auto rows = run(tolerance_cases(line, settings, 1e8));
  ASSERT_EQ(rows.size(), 2u);
  for (const Row& row : rows) {
    EXPECT_EQ(row.text("integrator"), "tr_bdf2");
    EXPECT_TRUE(row.ok()) << row.text("reason");
    EXPECT_EQ(row.number("tolerance_tightest"), 1e-5);
    EXPECT_GT(row.number("steps_usual"), 0);
    EXPECT_GT(row.number("work_usual"), row.number("steps_usual"));
  }
}

constexpr const char* springs = R"(
title = "springs"
duration_s = 0.05

[model]
id = "mass_spring"

[integrator]
id = "tr_bdf2"
position_tol_rel = 0.003

[material]
name = "custom"
radius_m = 1e-4
youngs_modulus_pa = 1e6
poisson_ratio = 0.3
density_kg_m3 = 1300

[strand]
elements = 4
length_m = 0.05

[effects.gravity]
)";

// Beside its largest step, though the scene has a tolerance of its own.
TEST(ToleranceLimit, OfAScene) {
  const auto path = std::filesystem::path(testing::TempDir()) / "springs_tolerance.toml";
  std::ofstream(path) << springs;
  CommandLine line;
  line.integrators = {"tr_bdf2", "backward_euler"};
  const SceneLimits how{{.coarsest = 0.01, .finest = 1e-4, .depth = 1}, 1e8, 0.05, 1, 1};
  const auto by_step = run(scene_cases(line, {path.string()}, how));
  ASSERT_EQ(by_step.size(), 2u);
  for (const Row& row : by_step) {
    EXPECT_TRUE(row.ok()) << row.text("reason");
    EXPECT_GT(row.number("dt_max_s"), 0);
  }
  const auto rows = run(scene_tolerance_cases(line, {path.string()}, how));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows.front().ok()) << rows.front().text("reason");
  EXPECT_EQ(rows.front().text("study"), "tolerance");
  EXPECT_EQ(rows.front().number("tolerance_loosest"), 1e-1);
  EXPECT_GE(rows.front().number("steps_usual"), 0.05 / 0.01);
}

// The horizon is the least time of a step, which is judged as far as a number of steps
// reaches; a tolerance is judged over the scene.
TEST(ToleranceLimit, OfASceneIsJudgedOverTheWholeScene) {
  const auto path = std::filesystem::path(testing::TempDir()) / "springs_horizon.toml";
  std::ofstream(path) << springs;
  CommandLine line;
  line.integrators = {"tr_bdf2"};
  const auto found = [&](double most_work) {
    const SceneLimits how{
        {.coarsest = 0.01, .finest = 1e-4, .depth = 1}, most_work, 0.02, 1, 1};
    return run(scene_tolerance_cases(line, {path.string()}, how)).at(0);
  };
  EXPECT_EQ(found(1e8).number("t_end_s"), 0.05);
  EXPECT_EQ(found(1).status(), "inconclusive");
}

TEST(ToleranceLimit, UnstableRodsByToleranceBreakAClaim) {
  const auto state = [](std::string_view limited_by) {
    Row row;
    row.set("study", "tolerance").set("scene", "release").set("model", "super_helix");
    row.set("limited_by", limited_by);
    Verdicts verdicts;
    check_stability_claims({row}, verdicts);
    return verdicts.all().back().state;
  };
  EXPECT_EQ(state("cap"), Verdicts::State::held);
  EXPECT_EQ(state("energy"), Verdicts::State::broken);
  EXPECT_EQ(state(""), Verdicts::State::not_judged);
}

}  // namespace tress::test_tolerance_limits
