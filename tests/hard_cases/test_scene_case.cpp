#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "contract/input_error.h"
#include "experiments/hard_cases/hard_cases.h"
#include "simulation/scene/scene.h"

namespace tress::test_scene_case {

using namespace experiments;
using namespace experiments::hard_cases;

using testing::HasSubstr;

constexpr double without_end = 1e12;  // work

/// A curl that gusts press against a wall.
constexpr const char* curl = R"(
title = "curl in wind beside a wall"
duration_s = 0.3

[model]
id = "super_helix"

[integrator]
id = "backward_euler"
dt_s = 0.002

[material]
name = "hair.caucasian"

[strand]
elements = 20
length_m = 0.1
root_tangent = [0, 0, -1]
shape = "helix"
curl_radius_m = 0.005

[effects.gravity]

[effects.wind]
velocity_m_s = [-5, 0, 0]

[[effects.body]]
shape = "plane"
centre_m = [-0.012, 0, 0]
rotation_rad = [0, 1.5707963267948966, 0]
stiffness_n_m2 = 10
)";

/// Hangs sideways, then falls: a rod as soft as rubber.
constexpr const char* soft = R"(
title = "soft strand"
duration_s = 0.3

[model]
id = "der"

[integrator]
id = "backward_euler"
dt_s = 0.002

[material]
name = "custom"
radius_m = 1e-3
youngs_modulus_pa = 1e6
poisson_ratio = 0.45
density_kg_m3 = 1000

[strand]
elements = 10
length_m = 0.2
root_tangent = [1, 0, 0]

[effects.gravity]
)";

Scene scene(const std::string& text) { return parse_scene(text, "mine.toml"); }

SceneSurvival survived(const Scene& which, const SceneCriteria& criteria = {},
                       double work = without_end) {
  return survive(which, {which.options.step}, criteria, which.duration, {work});
}

std::vector<Row> rows(const std::string& file, CommandLine line,
                      const std::vector<std::pair<std::string, std::string>>& more = {}) {
  line.quick = true;
  line.set = more;
  line.set.emplace_back("scenes", file);
  std::vector<Row> all;
  for (const Case& work : scene_cells(line, Settings(line, hard_case_settings()))) {
    Row row = work.identity;
    work.run(row, Deadline(600));
    all.push_back(row);
  }
  return all;
}

std::string file_of(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path) << text;
  return path.string();
}

// ---- what one run says --------------------------------------------------------------

TEST(SceneCase, ACurlInWindAgainstAWallSurvives) {
  const SceneSurvival s = survived(scene(curl));
  EXPECT_EQ(s.outcome, Outcome::stable) << s.why;
  EXPECT_NEAR(s.t, 0.3, 1e-9);
  EXPECT_EQ(s.measured, "depth_m");  // it does touch
  EXPECT_GT(*s.measure, 0);
  EXPECT_LE(*s.measure, s.limit);
  EXPECT_EQ(s.stats.steps, 150);
}

TEST(SceneCase, ATighterDepthFailsWithPlaceAndTime) {
  const SceneSurvival wide = survived(scene(curl));
  const double half = *wide.measure / 2;
  const SceneSurvival s = survived(scene(curl), {.depth = half});
  EXPECT_EQ(s.outcome, Outcome::unstable);
  EXPECT_EQ(s.limit, half);
  EXPECT_GT(*s.measure, half);
  EXPECT_LT(s.t, 0.3);
  EXPECT_THAT(s.why, HasSubstr("depth_m = "));
  EXPECT_THAT(s.why, HasSubstr(" s, strand 0, point "));
}

TEST(SceneCase, ATighterStretchFailsAtTheRootOfAHeavySoftStrand) {
  Scene heavy = scene(soft);
  const SceneSurvival s = survived(heavy, {.stretch = 1e-4});
  EXPECT_EQ(s.outcome, Outcome::unstable);
  EXPECT_EQ(s.measured, "stretch");
  EXPECT_THAT(s.why, HasSubstr(" s, strand 0, element "));
  EXPECT_EQ(survived(heavy).outcome, Outcome::stable);
}

// A passive strand gains nothing, a shaken one does.
TEST(SceneCase, EnergyIsJudgedWhereItIsAskedFor) {
  constexpr double gain = 1e-9;  // J, of 6e-4 J that falling sets free
  EXPECT_EQ(survived(scene(soft), {.energy_gain = gain}).outcome, Outcome::stable);
  const std::string shaken = std::string(soft) +
                             "[root]\nmotion = \"swing\"\namplitude_m = 0.05\n"
                             "frequency_hz = 5\n";
  const SceneSurvival s = survived(scene(shaken), {.energy_gain = gain});
  EXPECT_EQ(s.outcome, Outcome::unstable);
  EXPECT_THAT(s.why, HasSubstr("energy_gain_j = "));
}

TEST(SceneCase, WhatTheGuardFindsIsUnstable) {
  Scene explosive = scene(soft);
  explosive.integrator = "rk4";
  explosive.options.step = 1.0 / 30;
  explosive.guard = false;  // the case has its own
  const SceneSurvival s = survived(explosive);
  EXPECT_EQ(s.outcome, Outcome::unstable);
  EXPECT_THAT(s.why, HasSubstr("at t = "));
  EXPECT_TRUE(std::isnan(s.limit));
  EXPECT_THAT(std::string(s.criterion), HasSubstr("guard"));
}

TEST(SceneCase, EndsWithItsWork) {
  const SceneSurvival s = survived(scene(soft), {}, 1e4);
  EXPECT_EQ(s.outcome, Outcome::not_finished);
  EXPECT_THAT(s.why, HasSubstr("its work was done at t = "));
  EXPECT_LT(s.t, 0.3);
}

/// As many steps as it needs, of which some are rejected: that is no failure.
TEST(SceneCase, SurvivesByTolerance) {
  Scene controlled = scene(curl);
  controlled.integrator = "tr_bdf2";
  const Pace pace{1.0 / 30, 1e-3};
  const SceneSurvival s = survive(controlled, pace, {}, 0.3, {without_end});
  EXPECT_EQ(s.outcome, Outcome::stable) << s.why;
  EXPECT_NEAR(s.t, 0.3, 1e-9);
  EXPECT_GT(s.stats.rejected, 0);
  EXPECT_EQ(s.measured, "depth_m");
  const double half = *s.measure / 2;
  const SceneSurvival tight =
      survive(controlled, pace, {.depth = half}, 0.3, {without_end});
  EXPECT_EQ(tight.outcome, Outcome::unstable);
  EXPECT_GT(*tight.measure, half);
}

// A tolerance may need any number of steps before the next look.
TEST(SceneCase, EndsWithItsWorkByTolerance) {
  Scene controlled = scene(soft);
  controlled.integrator = "tr_bdf2";
  const SceneSurvival s = survive(controlled, {1.0 / 30, 1e-6}, {}, 0.3, {2e4});
  EXPECT_EQ(s.outcome, Outcome::not_finished) << s.why;
  EXPECT_LT(s.t, 0.3);
}

// ---- rows ---------------------------------------------------------------------------

TEST(SceneCase, IsTriedByEveryModelAtItsStepAndOurs) {
  const std::string file = file_of("rows.toml", soft);
  CommandLine line;
  line.models = {"der", "super_helix"};
  line.integrators = {"backward_euler", "xpbd"};
  const auto found = rows(file, line);
  ASSERT_EQ(found.size(), 12U);  // 2 models, 2 integrators, 3 steps
  for (const Row& row : found) {
    EXPECT_EQ(row.text("case"), "rows");
    const bool able = row.text("integrator") == "backward_euler";
    if (able) {
      EXPECT_EQ(row.text("outcome"), "stable") << row.text("why");
      EXPECT_TRUE(row.ok());
    } else if (row.text("model") == "super_helix") {
      EXPECT_EQ(row.text("outcome"), "refused");
      EXPECT_EQ(row.status(), "refused");
      EXPECT_THAT(std::string(row.text("why")), HasSubstr("xpbd"));
    }
  }
  EXPECT_EQ(rows(file, line, {{"dt_s", "0.002"}}).size(), 4U);
}

/// The scene's own and ours; a method with fixed steps has none of them.
TEST(SceneCase, IsTriedAtItsTolerance) {
  std::string text = soft;
  const std::string method = "id = \"backward_euler\"\ndt_s = 0.002";
  text.replace(text.find(method), method.size(),
               "id = \"tr_bdf2\"\nposition_tol_rel = 0.005\nmax_step_s = 0.02");
  const std::string file = file_of("tolerance.toml", text);
  CommandLine line;
  line.models = {"der"};
  line.integrators = {"backward_euler", "tr_bdf2"};
  std::vector<std::string> paces;
  for (const Row& row : rows(file, line)) {
    EXPECT_EQ(row.text("outcome"), "stable") << row.text("why");
    if (row.text("integrator") != "tr_bdf2") continue;
    paces.push_back(std::string(row.text("dt_s")) + " " +
                    std::string(row.text("position_tol_rel")));
  }
  EXPECT_EQ(paces, (std::vector<std::string>{"0.02 0.005", "0.03333333333333333 0.001"}));
  EXPECT_EQ(rows(file, line, {{"position_tol_rel", "0.005"}}).size(), 1U);
}

// Error control holds constraints by projection, where fixed steps hold index 3.
TEST(SceneCase, ModelsWithConstraintsAreTriedByTolerance) {
  CommandLine line;
  line.models = {"inextensible_strand"};
  line.integrators = {"tr_bdf2"};
  const auto found =
      rows(file_of("constrained.toml", soft), line, {{"position_tol_rel", "1e-3"}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().text("formulation"), "projection");
  EXPECT_EQ(found.front().text("outcome"), "stable") << found.front().text("why");
}

TEST(SceneCase, ATreeHasItsOwnModelOnly) {
  const std::string tree = TRESS_SCENES "/palm_tree.toml";
  CommandLine line;
  line.integrators = {"backward_euler"};
  for (const Row& row : rows(tree, line, {{"horizon_s", "0.05"}})) {
    EXPECT_EQ(row.text("model"), "super_helix_tree");
    EXPECT_TRUE(row.ok()) << row.text("why");
  }
  line.models = {"der"};
  EXPECT_TRUE(rows(tree, line).empty());
}

TEST(SceneCase, RefusesWhatTheSceneSaysItself) {
  const std::string file = file_of("refused.toml", soft);
  EXPECT_THROW(rows(file, {}, {{"case", "cone"}}), InputError);
  EXPECT_THROW(rows(file, {}, {{"length_m", "0.2"}}), InputError);
  EXPECT_THROW(rows(file + "," + file, {}), InputError);
  EXPECT_THROW(rows(file, {}, {{"most_stretch", "0.6"}}), InputError);
}

// The answer on screen: a line for each model, and which of its methods stay stable.
TEST(SceneCase, TellsWhichMethodsStayStable) {
  const auto row = [](std::string_view model, std::string_view variant,
                      std::string_view integrator, double dt, Outcome outcome) {
    Row one;
    one.set("model", model).set("variant", variant).set("integrator", integrator);
    one.set("dt_s", dt).set("outcome", name(outcome));
    return one;
  };
  std::vector<Row> all;
  for (const double dt : {0.001, 0.01}) {
    const bool fine = dt < 0.005;
    all.push_back(row("der", "", "rk4", dt, Outcome::unstable));
    all.push_back(
        row("der", "", "bdf2", dt, fine ? Outcome::stable : Outcome::not_finished));
    all.push_back(row("super_helix", "jacobian=exact", "bdf2", dt, Outcome::stable));
    all.push_back(row("super_helix", "jacobian=elastic", "bdf2", dt, Outcome::stable));
    all.push_back(
        row("super_helix", "", "rk4", dt, fine ? Outcome::stable : Outcome::unstable));
  }
  all.push_back(row("corde", "", "xpbd", 0.001, Outcome::refused));
  EXPECT_EQ(
      hard_answer(all),
      (std::vector<std::string>{
          "super_helix: 5 of 6 runs are stable; stable in all of their runs, 2 of 3 "
          "methods: bdf2 (jacobian=elastic), bdf2 (jacobian=exact)",
          "der: 1 of 4 runs are stable; no method is stable in all of its runs",
          "not supported: 1 of 11 runs; the column 'why' has the reasons"}));
}

}  // namespace tress::test_scene_case
