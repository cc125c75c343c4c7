// Which hairs of a head to simulate, and how finely: errors, their parts, and answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/head_accuracy/grooms.h"
#include "experiments/head_accuracy/head_accuracy.h"
#include "simulation/run/world.h"
#include "simulation/scene_changes/changes.h"
#include "tests/harness/toy_process.h"

namespace tress::test_head_accuracy {

using namespace experiments;
using namespace experiments::head_accuracy;

constexpr double pi = std::numbers::pi;

// --- curves and errors -----------------------------------------------------------------

/// A circle of this curvature through `elements` chords.
HairCurves circle(double curvature, double length, int elements, double moved = 0) {
  HairCurves made{1, elements, {{}}};
  for (int i = 0; i <= elements; ++i) {
    const double angle = curvature * length * i / elements;
    made.x[0].insert(made.x[0].end(), {std::sin(angle) / curvature + moved * i,
                                       (1 - std::cos(angle)) / curvature, 0});
  }
  return made;
}

TEST(HairCurves, AreNearTheCurveBetweenPoints) {
  const double c = 60, length = 0.2;
  const int n = 16;
  const double d = length / n;
  const HairCurves curve = circle(c, length, n);
  double most = 0;
  for (int i = 0; i <= 200; ++i) {
    const double share = i / 200.0, angle = c * length * share;
    most = std::max(most, norm(curve.at(0, 0, share) -
                               Vec{std::sin(angle) / c, (1 - std::cos(angle)) / c, 0}));
  }
  // The product of the four distances is at most d^4 in the outer intervals, over 4!.
  EXPECT_LT(most, std::pow(c, 3) * std::pow(d, 4) / 24);
  EXPECT_GT(most, 1e-3 * std::pow(c, 3) * std::pow(d, 4));
}

TEST(HairCurves, ExtrapolationRemovesTheErrorItIsFor) {
  HairCurves exact{1, 4, {std::vector<double>(15, 1.0)}};
  const auto off = [&](HairCurves curve, double error) {
    for (double& x : curve.x[0]) x += error;
    return curve;
  };
  const HairCurves by_step = extrapolated_in_step(off(exact, 0.1), off(exact, 0.2));
  HairCurves coarse{1, 3, {std::vector<double>(12, 1.4)}};
  const HairCurves by_elements = extrapolated_in_elements(off(exact, 0.1), coarse);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_NEAR(by_step.x[0][i], 1, 1e-14);
    EXPECT_NEAR(by_elements.x[0][i], 1, 1e-14);
  }
}

TEST(HairErrors, AreRmsOverLengthAndInstants) {
  const HairCurves still{
      1, 8, {std::vector<double>(27, 0.0), std::vector<double>(27, 0.0)}};
  const std::vector<double> lengths{0.5};
  HairErrors errors(still, lengths);
  // Off by x = 0.04 s at the first instant and not at the second: 0.04/sqrt(3) by the
  // trapezoidal rule, which adds d^2/2 = 1/(2 n^2) to the mean square 1/3.
  const int n = 100;
  std::vector<Vec> moved, same(2);
  for (int i = 0; i <= n; ++i) moved.push_back({0.04 * i / n, 0, 0});
  errors.add(0, 0, moved);
  errors.add(1, 0, same);
  EXPECT_NEAR(errors.of(0), 0.04 * std::sqrt((1.0 / 3 + 1 / (6.0 * n * n)) / 2) / 0.5,
              1e-12);
}

TEST(Spread, WeighsHairs) {
  const std::vector<double> errors{4, 1, 2, 3}, alike{1, 1, 1, 1}, heavy{1, 97, 1, 1};
  EXPECT_EQ(spread(errors, alike).mean, 2.5);
  EXPECT_EQ(spread(errors, alike).p95, 4);
  EXPECT_EQ(spread(errors, alike).largest, 4);
  EXPECT_EQ(spread(errors, heavy).p95, 1);
  EXPECT_EQ(spread(errors, heavy).largest, 4);
}

// --- heads -----------------------------------------------------------------------------

constexpr std::size_t few = 96;

Scene groom(const std::string& name, std::size_t hairs = few) {
  return parse_scene(groom_text(name, hairs), name + ".toml");
}

Comparison small() {
  Comparison made;
  made.horizon = 0.25;
  made.elements = 24;
  made.substeps = 16;
  return made;
}

StudyPlan study(std::vector<double> targets) {
  StudyPlan plan;
  plan.comparison = small();
  plan.search.elements = {2, 4, 6, 8, 12};
  plan.search.substeps = {1, 2, 4, 8};
  plan.search.sample = 24;
  plan.targets = std::move(targets);
  return plan;
}

std::vector<Row> rows_of(const Scene& scene, const StudyPlan& plan) {
  Row identity;
  identity.set("scene", scene.name);
  return study_head(scene, plan, identity, Deadline(250));
}

const Row& only_one(const std::vector<Row>& rows, std::string_view kind) {
  const Row* found = nullptr;
  for (const Row& row : rows) {
    if (row.text("kind") != kind) continue;
    EXPECT_EQ(found, nullptr) << kind;
    found = &row;
  }
  if (found == nullptr) throw std::runtime_error("no such row");
  return *found;
}

TEST(HeadMeasure, PartsAreTheWholeWhereTheOtherVanishes) {
  const HeadMeasure measure(groom("wavy_alike_shaken"), small());
  EXPECT_LT(measure.gap().largest, 0.005);
  // Every hair simulated: no interpolation.
  const auto every = measure.trial({few, 6, 4, 64});
  ASSERT_TRUE(every);
  EXPECT_EQ(every->interpolation.largest, 0);
  EXPECT_EQ(every->all.mean, every->simulated.mean);
  EXPECT_EQ(every->all.largest, measure.simulated(few, 6, 4, 64).largest);
  EXPECT_GT(every->all.mean, 0.002);
  // Simulated as finely as the reference: what is left is interpolation, within what the
  // reference gained by its extrapolations.
  const auto fine = measure.trial({few / 4, 24, 16, 64});
  ASSERT_TRUE(fine);
  const double left = fine->simulated.largest;
  EXPECT_LT(left, 0.02);
  EXPECT_GT(fine->interpolation.mean, 0);
  EXPECT_NEAR(fine->all.mean, fine->interpolation.mean, 1.5 * left);
  // Guides are themselves: an error of all hairs is no larger than of those that follow.
  EXPECT_LE(fine->simulated.mean, fine->all.largest);
}

TEST(HeadMeasure, GuidesAreThoseThatTheSceneWouldHave) {
  Scene scene = groom("curly_varied_shaken");
  const Scene guided = with_guides(scene, 20);
  const std::vector<std::size_t> which = guides_of(scene, 20);
  ASSERT_EQ(guided.strands.size(), 20U);
  ASSERT_EQ(which.size(), 20U);
  EXPECT_EQ(guided.followers.size(), few - 20);
  for (std::size_t k = 0; k < 20; ++k) {
    const Vec apart =
        guided.strands[k].root.position - scene.strands[which[k]].root.position;
    EXPECT_EQ(norm(apart), 0);
  }
}

/// A groom of more hairs than are looked at is the same groom thinner: what it says holds
/// for all.
TEST(HeadMeasure, AThinnedGroomStandsForTheWhole) {
  Comparison thin = small();
  thin.hairs = few / 2;
  const HeadMeasure measure(groom("straight_alike_shaken"), thin);
  EXPECT_EQ(measure.hairs(), few / 2);
  EXPECT_EQ(measure.all_hairs(), few);
  const auto every = measure.trial({few / 2, 4, 2, 64}),
             guided = measure.trial({8, 4, 2, 64});
  ASSERT_TRUE(every && guided);
  // As much memory as all hairs: blocks of eight are full in both.
  const HeadMeasure whole(groom("straight_alike_shaken"), small());
  EXPECT_NEAR(every->bytes, whole.trial({few, 4, 2, 64})->bytes, 0.1 * every->bytes);
}

/// Hairs that are alike, with roots that are alike, move alike: one stands for all. Roots
/// lie within 1e-3 rad on a head of 0.1 m: 0.1 mm apart, and as much turned.
TEST(HeadSearch, OneGuideIsEnoughForHairsThatAreAlike) {
  std::string text = groom_text("curly_alike_shaken", few);
  text.replace(text.find("cap_angle_rad = 0.4"), 19, "cap_angle_rad = 0.001");
  const Scene scene = parse_scene(text, "alike.toml");
  const HeadMeasure measure(scene, small());
  // Directions 1e-3 apart over the length, and carried by a tangent that turns as much.
  EXPECT_LT(measure.interpolation(1, 8).largest, 4e-3);
  const std::vector<Row> rows = rows_of(scene, study({0.03}));
  const Row& answer = only_one(rows, "cheapest");
  ASSERT_TRUE(answer.ok()) << answer.text("reason");
  EXPECT_EQ(answer.text("guides"), "1");
  EXPECT_EQ(only_one(rows, "every").number("guides"), static_cast<double>(few));
  // Following one hair or being simulated alike: the same up to the former error.
  EXPECT_NEAR(only_one(rows, "every").number("error_mean_rel"),
              answer.number("error_mean_rel"), 4e-3);
}

class Family : public testing::TestWithParam<std::string> {};

/// Where hairs are alike some stand for others, and where each has its own length, curl
/// and phase none does; the answer says which, keeps its target, and is confirmed by its
/// own scene run as it would be by anyone.
TEST_P(Family, AnswersHoldAndSayWhereInterpolationFails) {
  const Scene scene = groom(GetParam());
  const double target = 0.03;
  const std::vector<Row> rows = rows_of(scene, study({target}));
  const Row& answer = only_one(rows, "cheapest");
  ASSERT_TRUE(answer.ok()) << answer.text("reason") << ' '
                           << answer.text("reference_gap");
  EXPECT_LE(answer.number("error_p95_rel") + answer.number("reference_gap"), target);
  EXPECT_LE(answer.number("margin"), neighbour_allowance);
  EXPECT_LE(answer.number("error_mean_rel"), answer.number("error_p95_rel"));
  EXPECT_LE(answer.number("error_p95_rel"), answer.number("error_max_rel"));
  const std::string said = advice(rows).front();
  if (GetParam().find("varied") != std::string::npos) {
    EXPECT_EQ(answer.number("guides"), static_cast<double>(few));
    EXPECT_GT(answer.number("best_interpolation_rel"), target);
    EXPECT_THAT(said, testing::HasSubstr("each of 96 hairs"));
    EXPECT_THAT(said, testing::HasSubstr("hairs that follow"));
  } else {
    EXPECT_LT(answer.number("best_interpolation_rel"), target / 2);
  }
  // No run of the front is beaten by an answer in both.
  for (const Row& row : rows) {
    if (row.text("kind") != "front" || !row.ok()) continue;
    EXPECT_TRUE(row.number("error_p95_rel") <= answer.number("error_p95_rel") ||
                row.number("ms_per_frame") <= answer.number("ms_per_frame"));
  }
}

INSTANTIATE_TEST_SUITE_P(Grooms, Family, testing::ValuesIn(groom_names()),
                         [](const auto& tested) { return tested.param; });

TEST(HeadStudy, IsReproducible) {
  const Scene scene = groom("curly_alike_shaken");
  StudyPlan plan = study({0.03});
  const auto first = rows_of(scene, plan);
  plan.comparison.threads = 3;
  const auto again = rows_of(scene, plan);
  for (const char* kind : {"cheapest", "precision", "as_given"}) {
    const Row &a = only_one(first, kind), &b = only_one(again, kind);
    for (const Column& column : head_columns()) {
      if (column.timing) continue;
      EXPECT_EQ(a.text(column.name), b.text(column.name)) << kind << ' ' << column.name;
    }
  }
}

TEST(HeadStudy, SaysWhatAReferenceCannotJudgeAndWhatIsOutOfReach) {
  const Scene scene = groom("wavy_varied_shaken");
  StudyPlan plan = study({1e-6});
  const Row unknown = only_one(rows_of(scene, plan), "cheapest");
  EXPECT_EQ(unknown.status(), "below_reference");
  plan.targets = {0.03};
  plan.search.elements = {2};
  const auto rows = rows_of(scene, plan);
  EXPECT_EQ(only_one(rows, "cheapest").status(), "not_met");
  EXPECT_THAT(advice(rows).front(), testing::HasSubstr("not_met"));
}

TEST(HeadStudy, TheMostAccurateWithinABudgetIsWithinIt) {
  StudyPlan plan = study({0.03});
  plan.budget_s = 10;  // longer than any run takes
  const auto rows = rows_of(groom("straight_alike_shaken"), plan);
  const Row& best = only_one(rows, "budget");
  ASSERT_TRUE(best.ok());
  EXPECT_LT(best.number("ms_per_frame"), 1e4);
  // The finest of the ladders, or what is as accurate.
  EXPECT_LT(best.number("error_p95_rel"),
            only_one(rows, "cheapest").number("error_p95_rel"));
  plan.budget_s = 1e-12;
  EXPECT_EQ(only_one(rows_of(groom("straight_alike_shaken"), plan), "budget").status(),
            "not_met");
}

/// The advised scene is that of the row, read and run by anyone: its guides are in the
/// same places at the end.
TEST(HeadStudy, AdvisedSceneIsTheRun) {
  const Scene given = groom("straight_alike_shaken");
  const auto rows = rows_of(given, study({0.01}));
  const Row& answer = only_one(rows, "cheapest");
  ASSERT_TRUE(answer.ok());
  const Scene scene = parse_scene(advised_text(given, answer), "advised.toml");
  EXPECT_EQ(scene.strands.size() + scene.followers.size(), few);
  EXPECT_EQ(static_cast<double>(scene.strands.size()), answer.number("guides"));
  EXPECT_EQ(static_cast<double>(scene.strands.front().segments.size()),
            answer.number("elements"));
  EXPECT_EQ(scene.options.step, answer.number("dt_s"));
}

// --- the program -----------------------------------------------------------------------

const std::string strand_scene =
    "title = \"t\"\nduration_s = 0.1\n[model]\nid = \"super_helix\"\njacobian = "
    "\"elastic\"\n[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = "
    "0.003\n[strand]\n";

TEST(HeadAccuracy, BadInputIsOneLineAndExitCodeTwo) {
  struct Bad {
    std::string arguments, problem, remedy;
  };
  for (const Bad& bad :
       {Bad{"--scene strand.toml", "a [strand] cannot be combined with hairs",
            "give [groom]s only"},
        Bad{"--scene curls.toml", "no SIMD lanes for lifted_curls", "super_helix"},
        Bad{"--scene springs.toml", "mass_spring: work is that of super-helices",
            "super_helix"},
        Bad{"--scene none.toml", "none.toml", "existing"},
        Bad{"--set grooms=curly", "unknown groom 'curly'", "curly_varied_shaken"},
        Bad{"--set reference_elements=4", "a reference of 4 elements", "8 or more"},
        Bad{"--set hairs=9000", "9000 hairs of 32 elements", "at most 200000"},
        Bad{"--set over=median", "median", "p95"},
        Bad{"--elements 5", "--elements", "leave it out"}}) {
    Toy toy;
    toy.write("strand.toml", strand_scene);
    toy.write(
        "curls.toml",
        "title = \"t\"\nduration_s = 0.1\n[model]\nid = \"lifted_curls\"\n[groom]\n");
    toy.write("springs.toml",
              "title = \"t\"\nduration_s = 0.1\n[model]\nid = \"mass_spring\"\n"
              "jacobian = \"filtered\"\n[integrator]\nid = \"linearly_implicit_euler\"\n"
              "dt_s = 0.003\n[groom]\n");
    const auto before = toy.files();
    const Toy::Result result = toy.run(bad.arguments);
    EXPECT_EQ(result.code, 2) << bad.arguments << result.err;
    EXPECT_EQ(result.error_lines(), 1) << result.err;
    EXPECT_THAT(result.err, testing::HasSubstr(bad.problem));
    EXPECT_THAT(result.err, testing::HasSubstr(bad.remedy));
    EXPECT_EQ(toy.files(), before);
  }
}

TEST(HeadAccuracy, AnswersAndWritesTheScene) {
  Toy toy;
  toy.write("lock.toml", groom_text("straight_alike_shaken", 64));
  const Toy::Result result = toy.run(
      "--scene lock.toml --quick --set horizon_s=0.1 --set accuracy=0.02 --budget 100 "
      "--out t.csv");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("lock, 2 %: take "));
  EXPECT_THAT(result.out, testing::HasSubstr("lock, 100 ms a frame: take "));
  EXPECT_THAT(toy.files(), testing::Contains("lock.advised.toml"));
}

}  // namespace tress::test_head_accuracy
