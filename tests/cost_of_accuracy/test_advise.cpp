#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

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

TEST(Advise, SaysThreeLinesAndWritesASceneThatRuns) {
  Toy process;
  process.write("hair.toml", sagging);
  const Toy::Result result = process.run("--advise hair.toml" + small);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 3) << result.out;
  EXPECT_THAT(result.out, HasSubstr("take super_helix"));
  EXPECT_THAT(result.out, HasSubstr("not as the file has it, der"));
  const Scene scene = parse_scene(process.read("hair.advised.toml"), "hair.advised.toml");
  EXPECT_EQ(scene.model->id, "super_helix");
  EXPECT_EQ(scene.integrator, "implicit_midpoint");
  World world(scene);
  EXPECT_EQ(world.advance(scene.duration), Status::ok) << world.failure();
}

TEST(Advise, WritesAToleranceAndHowToExtrapolate) {
  Toy process;
  process.write("hair.toml", sagging);
  std::string by_tolerance = small;
  by_tolerance.replace(by_tolerance.find("implicit_midpoint"), 17, "esdirk43");
  // One run without extrapolation takes four times as long there; twice, at a thousandth,
  // is what a busy machine may cost.
  by_tolerance += " --set accuracy=0.0003";
  const Toy::Result result = process.run("--advise hair.toml" + by_tolerance);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("esdirk43, tolerance"));
  const std::string text = process.read("hair.advised.toml");
  EXPECT_THAT(text, HasSubstr("the result is x + "));
  const Scene scene = parse_scene(text, "hair.advised.toml");
  EXPECT_GT(scene.options.tolerance, 0);
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
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("no run within 0.2 % so far"));
  EXPECT_THAT(result.out, HasSubstr("best so far super_helix"));
  EXPECT_THAT(result.out, HasSubstr("--set search_work"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("nothing")));
  EXPECT_TRUE(process.exists("hair.advised.toml"));
}

TEST(Advise, SaysThatTimeIsOver) {
  Toy process;
  process.write("hair.toml", sagging);
  const Toy::Result result = process.run(
      "--advise hair.toml --quick --timeout 0.1 --out table.csv "
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
  EXPECT_EQ(process.run("--budget -1" + small).code, 2);
}

}  // namespace tress::test_advise
