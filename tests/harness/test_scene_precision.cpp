#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/scaling/scaling.h"
#include "experiments/work_precision/work_precision.h"
#include "simulation/scene_changes/changes.h"

namespace tress::test_scene_precision {

using namespace experiments;
using namespace experiments::scaling;
using namespace experiments::work_precision;

using testing::HasSubstr;

std::string file(const std::string& name, const std::string& text) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "scene_precision";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name) << text;
  return (folder / name).string();
}

/// One strand of 5 elements that falls for some frames; `more`: tables and keys.
std::string falling(const std::string& strand, const std::string& more) {
  return R"(
title = "a strand"
duration_s = 0.1

[model]
id = "super_helix"

[integrator]
id = "linearly_implicit_euler"
dt_s = 0.001

[effects.gravity]
)" + more +
         R"(
[strand]
elements = 5
length_m = 0.1
root_tangent = [1, 0, 0]
)" + strand;
}

const std::string soft = falling("", R"(
[material]
name = "custom"
radius_m = 1e-3
youngs_modulus_pa = 1e5
poisson_ratio = 0.3
density_kg_m3 = 1000
internal_friction_kg_m3_s = 0
)");

const std::string curly = falling(
    "shape = \"helix\"\ncurl_radius_m = 0.01\n"
    "curl_pitch_m = 0.05\n",
    R"(
[effects.wind]
velocity_m_s = [1, 0, 0]
law = "quadratic"
strand_radius_m = 40e-6

[effects.body]
shape = "sphere"
centre_m = [0.05, 0, -0.035]
radius_m = 0.03
stiffness_n_m2 = 0.5
friction = 0.3
slip_speed_m_s = 0.02
)");

constexpr const char* tree = R"(
title = "a tree"
duration_s = 0.1

[model]
id = "super_helix_tree"
tree = "palm_tree"

[integrator]
id = "linearly_implicit_euler"
dt_s = 0.001
)";

std::vector<Row> run(const std::vector<Case>& cases) {
  std::vector<Row> all;
  for (const Case& work : cases) {
    if (work.run_rows) {
      for (Row& row : work.run_rows(work.identity, Deadline(600))) all.push_back(row);
      continue;
    }
    all.push_back(work.identity);
    work.run(all.back(), Deadline(600));
  }
  return all;
}

CommandLine line_of(const std::vector<std::string>& models,
                    const std::vector<std::string>& integrators) {
  CommandLine line;
  line.quick = true;
  line.repeat = 1;
  line.models = models;
  line.integrators = integrators;
  return line;
}

std::vector<Row> precision(const std::string& scene, const CommandLine& line) {
  std::vector<Row> rows = run(scene_runs(line, Settings(line, row_settings()), {scene}));
  add_series_columns(rows);
  return rows;
}

std::vector<Row> costs(const std::string& scene, const CommandLine& line) {
  std::vector<Row> rows = run(scene_costs(line, {scene}));
  add_exponents(rows);
  return rows;
}

// ---- work_precision --scene -------------------------------------------------------

TEST(ScenePrecision, OfASoftStrandFallsWithTheStepAtTheMethodsOrder) {
  CommandLine line = line_of({"super_helix"}, {"implicit_midpoint", "backward_euler"});
  line.set = {{"error", "time"}};
  const auto rows = precision(file("soft.toml", soft), line);
  std::set<std::string> integrators;
  for (const Row& row : rows) {
    ASSERT_TRUE(row.ok()) << row.text("reason");
    EXPECT_EQ(row.text("scene"), "soft.toml");
    EXPECT_EQ(row.text("error_kind"), "time");
    EXPECT_EQ(row.number("elements"), 5);
    EXPECT_GT(row.number("wall_s"), 0);
    EXPECT_EQ(row.number("steps"), std::round(0.1 / row.number("dt_s")));
    const double order = row.text("integrator") == "backward_euler" ? 1 : 2;
    EXPECT_NEAR(row.number("order_fit"), order, 0.3) << row.text("integrator");
    integrators.emplace(row.text("integrator"));
  }
  EXPECT_EQ(integrators.size(), 2u);
  EXPECT_EQ(rows.size(), 8u);  // four steps each
}

/// Beside the steps; constraints of clamped inextensible strands are projected, for there
/// is no error control on index 3, the usual formulation.
TEST(ScenePrecision, ByToleranceHasTheErrorAskedFor) {
  CommandLine line = line_of({"super_helix", "inextensible_strand"}, {"esdirk43"});
  line.set = {{"error", "time"}};
  int steps = 0, tolerances = 0;
  for (const Row& row : precision(file("soft.toml", soft), line)) {
    ASSERT_TRUE(row.ok()) << row.text("reason");
    ++(row.has("position_tol_rel") ? tolerances : steps);
    EXPECT_NE(row.has("position_tol_rel"), row.has("dt_s"));
    EXPECT_EQ(row.has("position_tol_rel"), row.has("error_over_tolerance"));
    if (!row.has("position_tol_rel")) continue;
    EXPECT_LE(row.number("error_over_tolerance"), 1);
    EXPECT_NE(row.text("formulation"), "index3");
  }
  EXPECT_EQ(steps, 8);
  EXPECT_EQ(tolerances, 6);
}

TEST(ScenePrecision, InAllEndsAtTheErrorOfTheElements) {
  CommandLine line = line_of({"super_helix"}, {"implicit_midpoint"});
  line.set = {{"error", "total"}};
  line.elements = {4, 12};
  double coarse = 1, fine = 1;
  for (const Row& row : precision(file("soft.toml", soft), line)) {
    ASSERT_TRUE(row.ok()) << row.text("reason");
    EXPECT_EQ(row.text("error_kind"), "total");
    double& least = row.number("elements") == 4 ? coarse : fine;
    least = std::min(least, row.number("error_rel"));
  }
  // Of order 2 in the element: a ninth, were there no error of time.
  EXPECT_LT(fine, coarse / 3);
}

TEST(ScenePrecision, OfACurlyStrandInTheWindOnASphereIsATable) {
  const CommandLine line = line_of({"super_helix", "der"}, {"linearly_implicit_euler"});
  std::set<std::string> kinds, models;
  for (const Row& row : precision(file("curly.toml", curly), line)) {
    EXPECT_FALSE(row.text("error_kind").empty() && row.ok());
    if (row.ok()) kinds.emplace(row.text("error_kind"));
    if (row.ok()) models.emplace(row.text("model"));
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"time", "total"}));
  EXPECT_EQ(models.size(), 2u);
}

TEST(ScenePrecision, OfAMethodThatTheModelCannotTakeIsARefusal) {
  CommandLine line = line_of({"super_helix"}, {"xpbd"});
  line.set = {{"error", "time"}};
  const auto rows = precision(file("soft.toml", soft), line);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows.front().status(), "refused");
  EXPECT_THAT(std::string(rows.front().text("reason")), HasSubstr("xpbd"));
}

TEST(ScenePrecision, OfExplicitStepsEndsWithTheWorkOfARun) {
  CommandLine line = line_of({"super_helix"}, {"explicit_euler"});
  line.set = {{"error", "time"}, {"row_work", "1e4"}};
  std::string stiff = soft;
  stiff.replace(stiff.find("1e5"), 3, "1e9");
  const auto rows = precision(file("stiff.toml", stiff), line);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows.front().status(), "solver_error");
  EXPECT_GT(rows.front().number("dt_s"), 1e-4);
}

TEST(ScenePrecision, OfStrandsThatTouchHasNoTotalError) {
  CommandLine line = line_of({"super_helix"}, {"linearly_implicit_euler"});
  line.set = {{"error", "total"}};
  const auto rows = precision(
      file("touching.toml", falling("", "[effects.strand_interaction]\n")), line);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows.front().status(), "refused");
  EXPECT_THAT(std::string(rows.front().text("reason")), HasSubstr("touch each other"));
}

TEST(ScenePrecision, RefusesATreeAndTwoScenesOfOneName) {
  const CommandLine line = line_of({}, {});
  const Settings settings(line, row_settings());
  const std::string strand = file("soft.toml", soft);
  EXPECT_THROW(scene_runs(line, settings, {file("tree.toml", tree)}), InputError);
  EXPECT_THROW(scene_runs(line, settings, {strand, strand}), InputError);
  const CommandLine other = line_of({"beam"}, {});
  EXPECT_THROW(scene_runs(other, Settings(other, row_settings()), {strand}), InputError);
}

// ---- scaling --scene --------------------------------------------------------------

TEST(SceneCosts, OfASoftAndOfACurlyStrandGrowWithElements) {
  CommandLine line = line_of({"super_helix", "der"}, {});
  line.elements = {20, 40, 80};
  for (const std::string& scene : {file("soft.toml", soft), file("curly.toml", curly)}) {
    const auto rows = costs(scene, line);
    EXPECT_EQ(rows.size(), 6u);
    for (const Row& row : rows) {
      ASSERT_TRUE(row.ok()) << row.text("reason");
      EXPECT_EQ(row.text("grows"), "elements");
      EXPECT_EQ(row.number("strands"), 1);
      EXPECT_GT(row.number("cost_per_step_s"), 0);
      EXPECT_TRUE(row.has("exponent"));
    }
  }
}

TEST(SceneCosts, OfSeveralStrandsGrowWithTheirNumber) {
  CommandLine line = line_of({"super_helix"}, {});
  line.elements = {5};
  std::string many = soft;
  for (const char* y : {"0.1", "0.2", "0.3", "0.4"}) {
    many += "[[strand]]\nelements = 5\nlength_m = 0.1\nposition_m = [0, " +
            std::string(y) + ", 0]\n";
  }
  many.replace(many.find("[strand]"), 8, "[[strand]]");
  std::vector<double> counts;
  for (const Row& row : costs(file("many.toml", many), line)) {
    ASSERT_TRUE(row.ok()) << row.text("reason");
    if (row.text("grows") == "strands") counts.push_back(row.number("strands"));
    EXPECT_EQ(row.has("exponent"), row.text("grows") == "strands");
  }
  EXPECT_EQ(counts, (std::vector<double>{1, 2, 4, 5}));
}

TEST(SceneCosts, OfAModelThatCannotDoTheSceneAreARefusal) {
  std::string flying = soft + "\n[root]\nmotion = \"free\"\n";
  const CommandLine line = line_of({"force_transport"}, {});
  for (const Row& row : costs(file("flying.toml", flying), line)) {
    EXPECT_EQ(row.status(), "refused");
    EXPECT_THAT(std::string(row.text("reason")), HasSubstr("free"));
  }
}

TEST(SceneCosts, RefuseATree) {
  EXPECT_THROW(scene_costs(line_of({}, {}), {file("tree.toml", tree)}), InputError);
}

// ---- the cut ----------------------------------------------------------------------

TEST(WithElements, CutsEveryStrandAnewAndKeepsItsShape) {
  const Scene given = read_scene(file("curly.toml", curly));
  const Scene cut = with_elements(given, 12);
  ASSERT_EQ(cut.strands.size(), given.strands.size());
  const Strand &a = given.strands.front(), &b = cut.strands.front();
  EXPECT_EQ(b.segments.size(), 12u);
  EXPECT_NEAR(b.length(), a.length(), 1e-15);
  EXPECT_NEAR(b.mass(), a.mass(), 1e-15 * a.mass() * 100);
  const Vec gap = b.segments[7].natural - a.segments[3].natural;  // a helix is uniform
  EXPECT_LE(norm(gap), 1e-12 * norm(a.segments[3].natural));
  EXPECT_EQ(cut.effects.size(), given.effects.size());
  EXPECT_THROW(with_elements(given, 0), InputError);
}

}  // namespace tress::test_scene_precision
