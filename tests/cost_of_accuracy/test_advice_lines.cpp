#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/cost_of_accuracy/study_rows.h"
#include "experiments/cost_of_accuracy/trial.h"

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

// The error alone may be within the target: the line says what is missing.
TEST(Advice, SaysWhatKeepsASmallErrorFromBeingAnAnswer) {
  Row best = configured("winner", 0.0012, 1).set("reference_gap", 0.001);
  best.failed("no_answer", "no run within the target").set("search", "cut: 3 of 204");
  auto lines = advice({best});
  EXPECT_EQ(lines[0], "no run within 1 % with neighbours that hold so far");
  EXPECT_TRUE(lines[1].ends_with("; its neighbours were not all examined")) << lines[1];
  best.set("worst_neighbour", "dt x 1.4").set("error_neighbours_rel", 0.1);
  EXPECT_TRUE(advice({best})[1].ends_with(
      "; its neighbour with dt x 1.4 has an error of 10 %, 1.5 % is allowed"))
      << advice({best})[1];
  best.set("reference_gap", 0.0095);
  EXPECT_TRUE(advice({best})[1].ends_with(
      "; this error and the gap of the references, 0.95 %, together exceed 1 %"))
      << advice({best})[1];
}

TEST(Advice, SaysOfAFileWithinTheTargetThatItsNeighboursWereNotExamined) {
  Row best = configured("winner", 0.04, 1).set("reference_gap", 0.002);
  best.failed("no_answer", "no run within the target");
  Row given = configured("as_given", 0.006, 2).set("reference_gap", 0.002);
  EXPECT_TRUE(advice({best, given})[2].ends_with("; its neighbours were not examined"));
  given.set("reference_gap", 0.005);
  EXPECT_FALSE(advice({best, given})[2].ends_with("not examined"));
}

TEST(Advice, SaysWhyTheFileAsGivenWasNotCompared) {
  Row given;
  given.set("scene", "s").set("kind", "as_given").set("model", "der");
  given.failed("diverged", "the scene as given: takes too long");
  const std::string line =
      "your file was not compared: the scene as given: takes too long";
  EXPECT_EQ(advice({configured("winner", 0.009, 1), given}).back(), line);
  Row best = configured("winner", 0.04, 1);
  best.failed("no_answer", "no run within the target");
  EXPECT_EQ(advice({best, given}).back(), line);
}

TEST(Advice, HasNoAnswerForAnUnmetTarget) {
  for (const std::string_view status : {"not_met", "below_reference"}) {
    std::vector<Row> rows{configured("winner", 0.04, 1), configured("front", 0.04, 1)};
    for (Row& row : rows) row.failed(status, "why");
    mark_unanswered(rows);
    EXPECT_EQ(rows[0].status(), "no_answer");
    EXPECT_EQ(rows[0].text("reason"), "why");
    EXPECT_EQ(rows[1].status(), status);
  }
}

TEST(Advice, NamesTheRemedyForATargetBelowTheGap) {
  StudyPlan plan;
  plan.advise = true;
  Row identity;
  Study study{.plan = plan, .given = {}, .identity = identity};
  study.reference.tips.gap = 0.005;
  EXPECT_EQ(below_reference(study, 0.01),
            "target 1 % < 4 x 0.5 %, the gap of the references: give --set "
            "accuracy=0.021 or more, or more time (--set answer_s)");
}

// A neighbour that fails has an infinite error: the run is shown all the same.
TEST(Advice, KnowsTheBestRunWhereNoNeighbourHolds) {
  Trial run{0, 4, 1, 0.004, 2};
  run.neighbours = never;
  const std::vector<Trial> runs{run};
  EXPECT_EQ(most_accurate(runs, never, 0), &runs[0]);
}

// No run of the search came to its end; the file as given did.
TEST(Advice, ShowsTheFileAsGivenWhereThereIsNoRun) {
  Row none;
  none.set("scene", "s").set("kind", "winner").set("target_error_rel", 0.01);
  none.set("search", "cut: 1 of 65 methods searched, by the clock");
  none.failed("no_answer", "no run came to its end within 10 % of the length");
  const auto lines = advice({none, configured("as_given", 0.04, 2)});
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "no answer: no run came to its end within 10 % of the length");
  EXPECT_TRUE(lines[1].starts_with("your file: der,")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("the search is incomplete ("));
}

TEST(Advice, SaysOnceThatThereIsNoOther) {
  const auto lines = advice({configured("winner", 0.009, 1)});
  EXPECT_EQ(lines.back(),
            "next best: no other model or integrator was found within the target");
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
