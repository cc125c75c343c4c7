#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/problems/strand_problems.h"
#include "experiments/work_precision/work_precision_series.h"

namespace tress::test_work_precision {

Row run(std::string_view kind, std::string_view solver, int elements, double dt,
        double error, double wall = 1) {
  Row row;
  row.set("scene", "strand").set("model", "super_helix").set("integrator", "bdf2");
  row.set("formulation", "parametric").set("solver", solver).set("elements", elements);
  row.set("error_kind", kind).set("dt_s", dt).set("error_rel", error);
  return row.set("wall_s", wall).set("below_reference", false);
}

TEST(SeriesColumns, TimeErrorsFallWithTheStepSolverBySolver) {
  std::vector<Row> rows;
  for (const double dt : {1e-3, 2e-3, 4e-3}) {
    rows.push_back(run("time", "recursive", 10, dt, dt * dt));
    rows.push_back(run("time", "sparse", 10, dt, dt * dt * dt));
  }
  add_series_columns(rows);
  for (const Row& row : rows) {
    EXPECT_NEAR(row.number("order_fit"), row.text("solver") == "sparse" ? 3 : 2, 1e-12);
  }
}

TEST(SeriesColumns, TotalErrorsFallWithTheElementAtTheFinestStep) {
  std::vector<Row> rows;
  for (const int elements : {5, 10, 20, 40, 80}) {
    const double length = 1. / elements;
    for (const double dt : {1e-3, 2e-3}) {
      // At the coarse step time decides, and the slope would be next to 0.
      const double time = dt == 2e-3 ? 1 : 0;
      rows.push_back(run("total", "recursive", elements, dt, length * length + time));
    }
  }
  add_series_columns(rows);
  for (const Row& row : rows) {
    const bool finest = row.number("dt_s") == 1e-3;
    EXPECT_EQ(row.has("order_fit"), finest);
    if (finest) {
      EXPECT_NEAR(row.number("order_fit"), 2, 1e-12);
    }
  }
}

TEST(SeriesColumns, KindsOfErrorDoNotCompete) {
  std::vector<Row> rows{run("time", "recursive", 10, 1e-3, 1e-6, 1),
                        run("total", "recursive", 10, 1e-3, 1e-3, 2),
                        run("total", "recursive", 10, 2e-3, 2e-3, 3)};
  add_series_columns(rows);
  EXPECT_EQ(rows[0].text("pareto"), "true");
  EXPECT_EQ(rows[1].text("pareto"), "true");
  EXPECT_EQ(rows[2].text("pareto"), "false");
}

TEST(StrandProblems, AreOfTimeOnEverySolverAndOfTheRod) {
  const auto all = strand_problems();
  EXPECT_EQ(std::ranges::count(all, "time", &Problem::error_kind), 1);
  EXPECT_GE(std::ranges::count(all, "total", &Problem::error_kind), 10);
  for (const Problem& problem : all) {
    EXPECT_EQ(problem.name, "strand_release");
    EXPECT_GT(problem.reference_gap, 0);
    for (const std::string_view solver : problem.solvers) {
      EXPECT_NE(problem.make(solver), nullptr);
    }
    for (const Checkpoint& at : problem.reference) {
      ASSERT_EQ(at.values.size(), 2u);
      // The tip stays within the strand's 10 cm of the root.
      EXPECT_LE(std::hypot(at.values[0], at.values[1]), 0.1 * (1 + 1e-4));
    }
  }
}

TEST(StrandProblems, SolversOfOneModelMakeOneError) {
  const Problem& problem = strand_problems().front();
  ASSERT_EQ(problem.error_kind, "time");
  ASSERT_EQ(problem.solvers.size(), 3u);
  Options options;
  options.step = 1e-3;
  std::vector<double> errors;
  for (const std::string_view solver : problem.solvers) {
    const ProblemRun run = run_problem(problem, "implicit_midpoint", options, solver);
    ASSERT_EQ(run.end.status, Status::ok) << run.end.failure;
    errors.push_back(run.error.relative);
  }
  EXPECT_GT(errors.front(), 100 * problem.reference_gap);
  // Newton stops at 1e-10 of a curvature of 1/L in each of 250 steps.
  for (const double error : errors) EXPECT_NEAR(error, errors.front(), 250e-10);
}

TEST(StrandProblems, TotalErrorsFallWithElements) {
  Options options;
  options.step = 2.5e-4;
  std::vector<double> errors;
  for (const Problem& problem : strand_problems()) {
    if (problem.error_kind != "total" || problem.model != "super_helix") continue;
    if (problem.elements != 5 && problem.elements != 10) continue;
    const ProblemRun run = run_problem(problem, "implicit_midpoint", options);
    ASSERT_EQ(run.end.status, Status::ok) << run.end.failure;
    EXPECT_GT(run.error.relative, 100 * problem.reference_gap);
    errors.push_back(run.error.relative);
  }
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_LE(errors[1], errors[0] / 2);
}

}  // namespace tress::test_work_precision
