#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "experiments/run/progress.h"
#include "simulation/files/csv.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"
#include "tests/harness/toy_process.h"

namespace tress::test_advise {

using namespace simulation;

using testing::HasSubstr;

const char* const sagging = R"(
title = "a hair sags"
duration_s = 0.1
[model]
id = "der"
[integrator]
id = "backward_euler"
dt_s = 0.0005
[strand]
elements = 30
[effects.gravity]
)";

/// A reference for tests takes a second.
const std::string small =
    " --quick --out table.csv --set reference_elements=16 --set reference_substeps=16 "
    "--set references=reference --models super_helix --integrators implicit_midpoint";

/// The line of a text that begins so; empty if there is none.
std::string line_of(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(start)) return line;
  }
  return "";
}

Row winner_of(const Toy& process) {
  for (const Row& row : parse_csv(process.read("table.csv"), "table.csv").rows) {
    if (row.text("kind") == "winner") return row;
  }
  return {};
}

TEST(Advise, SaysWhatToTakeAndWritesASceneThatRuns) {
  Toy process;
  process.write("hair.toml", sagging);
  const Toy::Result result = process.run("--advise hair.toml" + small);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(line_of(result.out, "take "), HasSubstr("take super_helix"));
  EXPECT_THAT(line_of(result.out, "take "), HasSubstr("over the whole 0.1 s"));
  EXPECT_THAT(result.out, HasSubstr("\nrobust: the worst of 6 neighbours is "));
  EXPECT_THAT(result.out, HasSubstr("your file, der"));
  EXPECT_THAT(result.out, HasSubstr("\ntable: table.csv\n"));
  const Scene scene = parse_scene(process.read("hair.advised.toml"), "hair.advised.toml");
  EXPECT_EQ(scene.model->id, "super_helix");
  EXPECT_EQ(scene.integrator, "implicit_midpoint");
  World world(scene);
  EXPECT_EQ(world.advance(scene.duration), Status::ok) << world.failure();
}

// A promise is about the scene as it is written, all of it.
TEST(Advise, ComparesTheWholeScene) {
  Toy process;
  std::string longer = sagging;
  longer.replace(longer.find("0.1"), 3, "0.8");
  process.write("hair.toml", longer);
  ASSERT_EQ(process.run("--advise hair.toml" + small).code, 0);
  EXPECT_EQ(winner_of(process).number("horizon_s"), 0.8);
  const Toy::Result cut = process.run("--advise hair.toml --set horizon_s=0.2" + small);
  ASSERT_EQ(cut.code, 0) << cut.err;  // as asked
  EXPECT_TRUE(
      cut.out.starts_with("valid for the first 0.2 s of 0.8 s, as requested: take "))
      << cut.out;
  EXPECT_THAT(process.read("hair.advised.toml"),
              HasSubstr("over the first 0.2 s of 0.8 s"));
}

std::string sagging_for(const std::string& duration_s) {
  std::string text = sagging;
  text.replace(text.find("0.1"), 3, duration_s);
  return text;
}

// 1.98 frames of 1/60 s.
TEST(Advise, ComparesTheEndThatIsNoWholeFrame) {
  Toy process;
  process.write("hair.toml", sagging_for("0.033"));
  const Toy::Result result = process.run("--advise hair.toml" + small);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(winner_of(process).number("horizon_s"), 0.033);
  EXPECT_EQ(winner_of(process).number("asked_s"), 0.033);
  EXPECT_THAT(line_of(result.out, "take "), HasSubstr("over the whole 0.033 s"));
}

// A scene of a quarter of a frame: its file has the frames that were compared.
TEST(Advise, ComparesWithinAFrame) {
  Toy process;
  process.write("hair.toml", sagging_for("0.004"));
  const Toy::Result result = process.run("--advise hair.toml" + small);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(winner_of(process).number("horizon_s"), 0.004);
  const Scene scene = parse_scene(process.read("hair.advised.toml"), "hair.advised.toml");
  EXPECT_EQ(scene.frame_rate, 1000);
}

// A soft hair without any friction, swung and stopped: nobody knows its motion for long.
TEST(Advise, SaysHowFarItIsValidWhereReferencesPart) {
  Toy process;
  process.write("wild.toml", R"(
title = "a soft hair without friction"
duration_s = 3
[model]
id = "super_helix"
[integrator]
id = "backward_euler"
dt_s = 0.001
[material]
name = "custom"
radius_m = 40e-6
youngs_modulus_pa = 1e6
poisson_ratio = 0.48
density_kg_m3 = 1300
internal_friction_kg_m3_s = 0
[strand]
length_m = 0.2
elements = 20
root_tangent = [1, 0, 0]
[effects.gravity]
)");
  const Toy::Result result = process.run(
      "--advise wild.toml --set answer_s=8 --out table.csv "
      "--models super_helix --integrators tr_bdf2,esdirk43");
  EXPECT_EQ(result.code, 3) << result.err;
  const std::string first = result.out.substr(0, result.out.find('\n'));
  EXPECT_TRUE(first.starts_with("valid for the first ") ||
              first.starts_with("no answer: ") || first.starts_with("no run within "))
      << first;
  EXPECT_THAT(first, testing::Not(testing::StartsWith("take ")));
}

TEST(Advise, KeepsReferencesOfOwnScenesBesideTheTable) {
  Toy process;
  process.write("hair.toml", sagging);
  std::string own = small;
  own.replace(own.find("--set references=reference"), 26, "");
  ASSERT_EQ(process.run("--advise hair.toml" + own).code, 0);
  EXPECT_TRUE(process.exists("table.reference/hair.csv"));
  EXPECT_FALSE(process.exists("results"));
}

TEST(Advise, WritesTheToleranceThatItSays) {
  Toy process;
  process.write("hair.toml", sagging);
  std::string by_tolerance = small;
  by_tolerance.replace(by_tolerance.find("implicit_midpoint"), 17, "esdirk43");
  const Toy::Result result = process.run("--advise hair.toml" + by_tolerance);
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string text = process.read("hair.advised.toml");
  const Scene scene = parse_scene(text, "hair.advised.toml");
  ASSERT_GT(scene.options.tolerance, 0);
  EXPECT_LE(scene.options.tolerance, 0.1);
  EXPECT_THAT(line_of(result.out, "take "),
              HasSubstr(fmt::format("esdirk43, tolerance {} (adaptive, mean step ",
                                    scene.options.tolerance)));
  EXPECT_EQ(winner_of(process).number("position_tol_rel"), scene.options.tolerance);
  World world(scene);
  EXPECT_EQ(world.advance(scene.duration), Status::ok) << world.failure();
}

TEST(Advise, KeepsTheReference) {
  Toy process;
  process.write("hair.toml", sagging);
  EXPECT_THAT(process.run("--advise hair.toml" + small).err, HasSubstr("computing"));
  EXPECT_THAT(process.run("--advise hair.toml" + small).err,
              testing::Not(HasSubstr("computing")));
  EXPECT_TRUE(process.exists("reference/hair.csv"));
  EXPECT_TRUE(process.exists("reference/hair.changed.meta.json"));
}

// A search that is over after its probes has answers, but no winner.
TEST(Advise, SaysTheBestSoFarWhereTheSearchWasCut) {
  Toy process;
  process.write("hair.toml", sagging);
  const Toy::Result result = process.run(
      "--advise hair.toml --set accuracy=0.002 --set search_work=0.0005" + small);
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("no run within 0.2 % with neighbours that hold so far"));
  EXPECT_THAT(line_of(result.out, "best so far "),
              HasSubstr("; its neighbours were not all examined"));
  EXPECT_THAT(result.out, HasSubstr("best so far super_helix"));
  EXPECT_THAT(result.out, HasSubstr("--set search_work"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("nothing")));
  EXPECT_THAT(process.read("hair.advised.toml"),
              HasSubstr("\n# No answer: its neighbours were not all examined.\n"));
}

TEST(Advise, SaysThatTimeIsOver) {
  Toy process;
  process.write("hair.toml", sagging);
  const Toy::Result result = process.run(
      "--advise hair.toml --quick --timeout 0.001 --out table.csv "
      "--set reference_substeps=4096 --set references=reference");
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_THAT(result.out, HasSubstr("out of time"));
  EXPECT_THAT(result.out, HasSubstr("--timeout"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("nothing")));
}

TEST(Advise, BudgetTakesTheBestInTheTimeThereIs) {
  Toy process;
  process.write("hair.toml", sagging);
  const Toy::Result result = process.run("--scene hair.toml --budget 100" + small);
  ASSERT_EQ(result.code, 0) << result.err;
  bool found = false;
  for (const Row& row : parse_csv(process.read("table.csv"), "table.csv").rows) {
    if (row.text("kind") != "budget") continue;
    found = true;
    EXPECT_LE(row.number("ms_per_frame"), 100);
    EXPECT_LE(row.number("error_rel"), 0.01);
  }
  EXPECT_TRUE(found);
}

TEST(Advise, RefusesWhatItCannotDo) {
  Toy process;
  process.write("bead.toml",
                "title = \"bead\"\n[model]\nid = \"bead_on_wire\"\n"
                "[integrator]\nid = \"backward_euler\"\nformulation = \"index3\"\n");
  const Toy::Result bead = process.run("--advise bead.toml" + small);
  EXPECT_EQ(bead.code, 2);
  EXPECT_THAT(bead.err, HasSubstr("geometry"));
  EXPECT_EQ(process.run("--advise none.toml" + small).code, 2);
  process.write("hair.toml", sagging);
  const Toy::Result both = process.run("--advise hair.toml --scene hair.toml" + small);
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--advise with --scene"));
  EXPECT_EQ(process.run("--budget -1" + small).code, 2);
}

}  // namespace tress::test_advise
