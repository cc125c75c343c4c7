#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"

namespace tress::test_advice_lines {

using namespace experiments;
using namespace experiments::cost_of_accuracy;

Row configured(std::string_view kind, double error, double wall) {
  Row row;
  row.set("scene", "s").set("kind", kind).set("target_error_rel", 0.01);
  row.set("model", kind == "winner" ? "super_helix" : "der");
  row.set("integrator", "tr_bdf2").set("elements", 8).set("dt_s", 0.01);
  row.set("error_rel", error).set("wall_s_per_sim_s", wall).set("ms_per_frame", wall);
  row.set("horizon_cut", false).set("horizon_s", 2).set("asked_s", 2);
  return row.set("duration_s", 2).set("search", "whole");
}

TEST(Advice, TakesWhatIsBothCheaperAndMoreAccurate) {
  const Row next = configured("runner_up", 0.008, 0.9).set("tied", true);
  std::vector<Row> rows{configured("winner", 0.009, 1), next};
  put_better_first(rows);
  const auto lines = advice(rows);
  EXPECT_TRUE(lines[0].starts_with("take der,")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("tied within 10 %: super_helix,")) << lines[1];
  // The table says the same.
  EXPECT_EQ(rows[0].text("model"), "der");
  EXPECT_EQ(rows[0].text("kind"), "winner");
  EXPECT_EQ(rows[0].number("cost_factor"), 1);
  EXPECT_EQ(rows[1].text("kind"), "runner_up");
  EXPECT_DOUBLE_EQ(rows[1].number("cost_factor"), 1 / 0.9);
  // Cheaper alone, or more accurate alone, is no reason: the winner is the simpler.
  std::vector<Row> simpler{configured("winner", 0.007, 1), next};
  put_better_first(simpler);
  EXPECT_TRUE(advice(simpler)[0].starts_with("take super_helix,"));
}

TEST(Advice, KeepsTheFileAsGivenWhereNoRunIsBetter) {
  Row best = configured("winner", 0.042, 1);
  best.failed("no_answer", "no run within the target").set("search", "cut: 0 of 204");
  std::vector<Row> rows{best, configured("as_given", 0.011, 2)};
  const auto lines = advice(rows);
  EXPECT_TRUE(lines[0].starts_with("no run within 1 % so far")) << lines[0];
  EXPECT_TRUE(lines[2].starts_with("your file is better: der,")) << lines[2];
  EXPECT_TRUE(lines[3].starts_with("the search is incomplete (cut: 0 of 204)"));
  EXPECT_FALSE(may_be_written(rows));
  rows[1] = configured("as_given", 0.05, 2);
  EXPECT_TRUE(advice(rows)[2].starts_with("your file: der,"));
  EXPECT_TRUE(may_be_written(rows));
}

TEST(Advice, CallsATieATie) {
  const auto lines = advice({configured("winner", 0.009, 1),
                             configured("runner_up", 0.0095, 1.05).set("tied", true)});
  EXPECT_TRUE(lines[1].starts_with("tied within 10 %: der,")) << lines[1];
}

TEST(Advice, BeginsWithTheTimeForWhichItIsValid) {
  Row row = configured("winner", 0.009, 1);
  EXPECT_TRUE(advice({row})[0].starts_with("take ")) << advice({row})[0];
  row.set("horizon_cut", true).set("horizon_s", 0.41).set("parted_rel", 0.12);
  EXPECT_TRUE(advice({row})[0].starts_with(
      "valid for the first 0.41 s of 2 s (beyond, the references differ by 12 % of the "
      "length): take "))
      << advice({row})[0];
  EXPECT_NE(advice({row})[0].find(", over the first 0.41 s of 2 s"), std::string::npos);
}

}  // namespace tress::test_advice_lines
