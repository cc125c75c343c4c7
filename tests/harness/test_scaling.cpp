#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/scaling/scaling.h"
#include "models/catalogue.h"
#include "models/reduced/trees.h"
#include "models/strand/strand_parameters.h"

namespace tress::test_scaling {

using namespace experiments;
using namespace experiments::scaling;

constexpr double eps = std::numeric_limits<double>::epsilon();

// ---- the fit ----------------------------------------------------------------------

// Logarithms and sums of three terms of order one: a few roundings.
TEST(LogLogSlope, OfAPowerLawIsItsExponent) {
  const std::vector<double> x{20, 50, 500};
  std::vector<double> y;
  y.reserve(x.size());
  for (const double n : x) y.push_back(3e-7 * std::pow(n, 1.7));
  EXPECT_NEAR(log_log_slope(x, y), 1.7, 100 * eps);
}

// By hand: log x = 0, 1, 2 and log y = 0, 0, 3 in units of log 2 has slope 3/2.
TEST(LogLogSlope, IsThatOfLeastSquares) {
  EXPECT_NEAR(log_log_slope(std::vector<double>{1, 2, 4}, std::vector<double>{1, 1, 8}),
              1.5, 100 * eps);
}

// ---- rows -------------------------------------------------------------------------

std::vector<ScalingCase> cases(const CommandLine& line) {
  return scaling_cases(line, Settings(line, scaling_settings()));
}

TEST(ScalingGrid, HasEverySolverTangentAndModeOnce) {
  std::set<std::string> rows, series;
  int largest_composite = 0, largest_recursive = 0;
  for (const ScalingCase& c : cases({})) {
    EXPECT_TRUE(rows.insert(describe(c.identity())).second) << describe(c.identity());
    series.insert(
        std::string(c.model->id).append(c.solver).append(c.jacobian).append(c.modes));
    if (c.structure != straight) continue;
    int& largest = c.solver == "composite" ? largest_composite : largest_recursive;
    largest = std::max(largest, c.elements);
  }
  // 3 solvers x 2 tangents x 3 modes of the super-helix, 2 x 2 of the chain, 3 of trees;
  // each other strand model by band and by KLU, or once where it has no choice.
  std::size_t others = 0;
  for (const ModelEntry* model : strand_models()) {
    if (model->id == "super_helix" || model->id == "articulated_chain") continue;
    others += first_word(*model, "solver").empty() ? 1 : 2;
  }
  EXPECT_EQ(series.size(), 18u + 4u + 3u + others);
  EXPECT_EQ(largest_recursive, 500);
  EXPECT_EQ(largest_composite, 200);
}

TEST(ScalingGrid, KeepsWhatTheCommandLineNames) {
  CommandLine line;
  line.elements = {300};
  line.set = {
      {"solver", "composite"}, {"jacobian", "elastic"}, {"structure", "straight"}};
  line.models = {"articulated_chain"};
  const auto rows = cases(line);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].elements, 300);  // asked for, however large
}

TEST(ScalingGrid, MakesTheSizesItNames) {
  const CommandLine line;
  const Settings settings(line, scaling_settings());
  for (const ScalingCase& c : cases(line)) {
    if (c.solver != "recursive" || c.elements > 30) continue;
    const int modes = c.modes == "bend_planar" ? 1 : c.modes == "bend" ? 2 : 3;
    const int unknowns = c.model->id == "super_clothoid" ? 2 * modes : modes;
    EXPECT_EQ(c.model->make(c.parameters(settings))->layout().coordinates,
              unknowns * c.elements)
        << describe(c.identity());
  }
}

// Poisson's ratio goes through text and E / (2 G) - 1: a few roundings.
TEST(ScalingGrid, TreesAreOfTheirMaterialAndUpright) {
  const CommandLine line;
  const Settings settings(line, scaling_settings());
  for (const ScalingCase& c : cases(line)) {
    if (c.structure == straight) continue;
    const Parameters p = c.parameters(settings);
    const Material made = material(p), expected = tree_material(c.structure);
    EXPECT_EQ(made.density, expected.density);
    EXPECT_EQ(made.youngs_modulus, expected.youngs_modulus);
    EXPECT_EQ(made.internal_friction, expected.internal_friction);
    EXPECT_NEAR(made.shear_modulus / expected.shear_modulus, 1, 8 * eps);
    EXPECT_EQ(root_motion(p).frame.e0.z, upright().e0.z);
  }
}

// [Bertails-Descoubes 2010]: composite and recursive, straight rods and trees.
TEST(ScalingGrid, TheSeedsFramesAreBesideItsMethodsOnly) {
  double composite_30 = 0, recursive_30 = 0, willow = 0;
  int given = 0;
  for (const ScalingCase& c : cases({})) {
    const auto fps = c.published_fps();
    if (!fps) continue;
    ++given;
    EXPECT_TRUE(c.in_seed_table());
    EXPECT_EQ(c.jacobian, "elastic");
    EXPECT_NE(c.model->id, "articulated_chain");
    if (c.structure == "willow") willow = *fps;
    if (c.elements != 30) continue;
    (c.solver == "composite" ? composite_30 : recursive_30) = *fps;
  }
  EXPECT_EQ(given, 2 * 5 + 5);
  EXPECT_EQ(composite_30, 1.4);
  EXPECT_EQ(recursive_30, 37);
  EXPECT_EQ(willow, 6);
}

// ---- what the table shows ---------------------------------------------------------

Row row(std::string_view structure, std::string_view solver, int elements, double cost,
        std::string_view modes = "bend_twist") {
  Row r;
  r.set("structure", structure).set("model", "super_helix").set("solver", solver);
  r.set("jacobian", "elastic").set("modes", modes).set("elements", elements);
  r.set("cost_per_step_s", cost);
  return r.set("cost_per_element_step_s", cost / elements);
}

std::vector<Row> power_law(std::string_view solver, double exponent) {
  std::vector<Row> rows;
  for (const int n : {10, 20, 100, 500}) {
    const double cost = n == 10 ? 1 : 1e-6 * std::pow(n, exponent);
    rows.push_back(row(straight, solver, n, cost));
  }
  return rows;
}

TEST(ScalingExponent, IsFittedFrom20ElementsOnPerSeries) {
  std::vector<Row> rows = power_law("recursive", 1.1);
  for (const Row& r : power_law("composite", 2.2)) rows.push_back(r);
  Row broken = row(straight, "recursive", 50, 1e3);
  rows.push_back(broken.failed("timeout", ""));
  rows.push_back(row("willow", "recursive", 242, 1));
  add_exponents(rows);
  for (const Row& r : rows) {
    if (r.text("structure") == "willow") {
      EXPECT_FALSE(r.has("exponent"));
    } else {
      EXPECT_NEAR(r.number("exponent"), r.text("solver") == "recursive" ? 1.1 : 2.2,
                  100 * eps);
    }
  }
}

TEST(ScalingExponent, NeedsThreeSizes) {
  std::vector<Row> rows{row(straight, "recursive", 20, 1),
                        row(straight, "recursive", 30, 2)};
  add_exponents(rows);
  EXPECT_FALSE(rows[0].has("exponent"));
}

std::vector<Verdicts::Verdict> figures(std::vector<Row> rows) {
  add_exponents(rows);
  Verdicts all;
  tell_scaling_figures(rows, all);
  for (const auto& verdict : all.all()) {
    EXPECT_EQ(verdict.state, Verdicts::State::figure);
    EXPECT_FALSE(verdict.alarm());
  }
  return all.all();
}

TEST(ScalingFigures, TheExponentIsNoVerdict) {
  const auto all = figures(power_law("recursive", 1.3));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_NEAR(all[0].value, 1.3, 100 * eps);
}

TEST(ScalingFigures, RatiosAreOfTheRowsTheyName) {
  const auto all = figures({
      row(straight, "recursive", 20, 40e-6),
      row(straight, "recursive", 20, 12e-6, "bend_planar"),
      row(straight, "recursive", 30, 30e-6),
      row(straight, "composite", 30, 50e-6),
      row(straight, "recursive", 100, 100e-6),
      row(straight, "composite", 100, 900e-6),
      row("willow", "recursive", 242, 300e-6),
      row("willow", "composite", 242, 9e-3),
  });
  ASSERT_EQ(all.size(), 6u);
  const std::vector<double> expected{2e-6, 5.0 / 3, 9, 30, 10.0 / 3};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(all[i + 1].value / expected[i], 1, 10 * eps) << all[i + 1].claim;
  }
}

TEST(ScalingFigures, WhatWasNotMeasuredIsNotTold) { EXPECT_TRUE(figures({}).empty()); }

// ---- stability of what is no scene ------------------------------------------------

// A hair released straight turns at most E(0) + m g L / 2 into motion; it loses a part
// of that to bending itself.
TEST(ReleaseBounds, AreOfTheKineticEnergyOfTheFall) {
  const StrandScene& scene = find_strand_scene("release");
  Parameters p(setup_parameters(find_model("super_helix")), "test");
  for (const auto& [key, value] : scene.settings) p.set(key, value);
  const auto system = find_model("super_helix").make(p);
  const double most = stability_bounds(scene, p, *system).energy;
  const double found = release_bounds(*system, perturbed_start(*system), 1).energy;
  EXPECT_LT(found, most);
  EXPECT_GT(found, 0.1 * most);
}

// Fast enough for steps of 1 ms to gain energy by the explicit gyroscopic terms.
TEST(ReleaseBounds, RefuseWhatTheirStepsDoNotResolve) {
  Parameters p(setup_parameters(find_model("super_helix")), "test");
  const auto system = find_model("super_helix").make(p);
  State start = initial_state(*system);
  for (double& rate : start.v) rate = 1e5;
  EXPECT_THROW((void)release_bounds(*system, start, 0.1), InputError);
}

}  // namespace tress::test_scaling
