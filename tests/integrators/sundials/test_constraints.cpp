#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "integrators/integrator_options.h"
#include "tests/support/drive.h"
#include "tests/support/small_systems.h"

namespace tress::test_constraints {

using namespace integrators;

using namespace testing_support;

constexpr double duration = 2;  // s: about one period

/// Where the point pendulum is after `duration`, by RK4 in its angle (error 1e-14).
std::vector<double> reference() {
  AnglePendulum system;
  Options options;
  options.step = 1e-4;
  Drive run("rk4", system, options);
  EXPECT_EQ(run.to(duration), Status::ok);
  const double angle = run.integrator->q()[0];
  return {std::sin(angle), -std::cos(angle)};
}

struct Outcome {
  Status status;
  double error, violation;
  Stats stats;
  std::string failure;
};

Options options_of(Formulation formulation, double tolerance) {
  Options options;
  options.formulation = formulation;
  options.rtol = options.atol = tolerance;
  options.alpha = 100;  // 1/s^2: 10 rad/s, critically damped
  options.beta = 20;    // 1/s
  return options;
}

Outcome swing(std::string_view id, const Options& options) {
  PointPendulum system;
  Drive run(id, system, options);
  double violation = 0;
  const Status status = run.to(duration, [&](double, In q, In) {
    violation = std::max(violation, PointPendulum::violation(q));
    return true;
  });
  return {status, run.distance(reference()), violation, run.integrator->stats(),
          run.integrator->failure()};
}

constexpr std::array tolerances{1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};

TEST(IdaStabilisedIndex2, HoldsTheConstraintToTheTolerance) {
  double previous = 1;
  for (const double tolerance : tolerances) {
    const Outcome run = swing("ida", options_of(Formulation::index2_ggl, tolerance));
    ASSERT_EQ(run.status, Status::ok) << run.failure;
    EXPECT_LE(run.violation, 10 * tolerance);
    EXPECT_LE(run.error, 100 * tolerance);
    EXPECT_LT(run.error, previous);
    previous = run.error;
    EXPECT_LE(run.stats.linearizations, run.stats.newton_iterations / 5);
  }
}

// The velocities and multipliers of higher-index forms carry errors of order h^-1 that no
// step is small enough for.
TEST(IdaStabilisedIndex2, IsSlowerWithMultipliersInTheErrorTest) {
  Options options = options_of(Formulation::index2_ggl, 1e-6);
  apply(options, "multiplier_atol", "1", "test");
  options.max_steps = 10'000;
  const Outcome out_of_test = swing("ida", options);
  apply(options, "suppress_algebraic", "false", "test");
  const Outcome in_test = swing("ida", options);
  ASSERT_EQ(out_of_test.status, Status::ok) << out_of_test.failure;
  const auto attempts = [](const Outcome& run) {
    return run.stats.steps + run.stats.rejected;
  };
  RecordProperty("attempts_suppressed", std::to_string(attempts(out_of_test)));
  RecordProperty("attempts_tested", std::to_string(attempts(in_test)));
  EXPECT_LT(attempts(out_of_test), attempts(in_test));
}

// Known limits: loose tolerances work at the price of many repeated steps, tight ones
// fail or crawl. Either is a row: the run ends, g holds where it got to, and it says why.
TEST(IdaIndex3, EndsWithAResultOrAReason) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    Options options = options_of(Formulation::index3, tolerance);
    options.max_steps = 20'000;
    const Outcome run = swing("ida", options);
    EXPECT_LE(run.violation, 10 * tolerance);
    if (run.status == Status::ok) {
      EXPECT_LE(run.error, 1000 * tolerance);
      EXPECT_GT(run.stats.rejected, run.stats.steps / 10);
    } else {
      EXPECT_THAT(run.failure, testing::HasSubstr("ida at t = "));
    }
  }
}

struct Pair {
  std::string_view id;
  Formulation formulation;
};

std::string pair_name(const testing::TestParamInfo<Pair>& chosen) {
  return std::string(chosen.param.id) + "_" + std::string(name(chosen.param.formulation));
}

class Index1 : public testing::TestWithParam<Pair> {};

TEST_P(Index1, ErrorFallsWithTheTolerance) {
  std::vector<double> errors;
  for (const double tolerance : tolerances) {
    const auto [id, formulation] = GetParam();
    const Outcome run = swing(id, options_of(formulation, tolerance));
    ASSERT_EQ(run.status, Status::ok) << run.failure;
    errors.push_back(run.error);
    // Drift adds to the error of the method: 1000 rtol, and rtol^{2/3} at order 2.
    EXPECT_LE(run.error,
              id == "cvode_bdf" ? 100 * std::pow(tolerance, 2.0 / 3) : 1000 * tolerance);
  }
  EXPECT_LT(errors.back(), 1e-2 * errors.front());
}

INSTANTIATE_TEST_SUITE_P(Sundials, Index1,
                         testing::Values(Pair{"cvode_adams", Formulation::acceleration},
                                         Pair{"cvode_adams", Formulation::baumgarte},
                                         Pair{"cvode_bdf", Formulation::acceleration},
                                         Pair{"cvode_bdf", Formulation::baumgarte},
                                         Pair{"arkode_erk", Formulation::acceleration},
                                         Pair{"arkode_erk", Formulation::baumgarte},
                                         Pair{"arkode_dirk", Formulation::acceleration},
                                         Pair{"arkode_dirk", Formulation::baumgarte},
                                         Pair{"ida", Formulation::acceleration},
                                         Pair{"ida", Formulation::baumgarte}),
                         pair_name);

class Feedback : public testing::TestWithParam<std::string_view> {};

// After one period of g'' = 0 the violation has grown with t^2; feedback has forgotten
// all but the last 1/10 s of it.
TEST_P(Feedback, ViolatesLessThanNone) {
  const Outcome with = swing(GetParam(), options_of(Formulation::baumgarte, 1e-6));
  const Outcome without = swing(GetParam(), options_of(Formulation::acceleration, 1e-6));
  EXPECT_LT(with.violation, 0.5 * without.violation);
}

INSTANTIATE_TEST_SUITE_P(Sundials, Feedback,
                         testing::Values("cvode_adams", "cvode_bdf", "arkode_erk",
                                         "arkode_dirk", "ida"),
                         [](const testing::TestParamInfo<std::string_view>& chosen) {
                           return std::string(chosen.param);
                         });

// Projection stops at 64 eps of g (projection.cpp) or a thousand times that where
// rounding stops it before: 1.4e-11.
TEST(CvodeBdfProjection, HoldsTheConstraintToRoundingAndFollowsTheTolerance) {
  double previous = 1;
  for (const double tolerance : tolerances) {
    const Outcome run =
        swing("cvode_bdf", options_of(Formulation::projection, tolerance));
    ASSERT_EQ(run.status, Status::ok) << run.failure;
    EXPECT_LE(run.violation, 1e-12);
    EXPECT_LE(run.error, 10 * std::pow(tolerance, 2.0 / 3));
    EXPECT_LT(run.error, previous);
    previous = run.error;
  }
}

// The error estimate without its part across the constraint asks for fewer steps than the
// drifting form, whose whole error is tested.
TEST(CvodeBdfProjection, TakesNoMoreStepsThanTheDriftingForm) {
  const Outcome held = swing("cvode_bdf", options_of(Formulation::projection, 1e-7));
  const Outcome free = swing("cvode_bdf", options_of(Formulation::acceleration, 1e-7));
  EXPECT_LE(held.stats.steps, free.stats.steps);
}

TEST(CvodeBdfProjection, RecoversFromAStartThatViolates) {
  PointPendulum system;
  Drive run("cvode_bdf", system, options_of(Formulation::projection, 1e-6));
  const std::vector<double> q{1.05, 0}, v{0.2, 0.1};
  ASSERT_EQ(run.integrator->start(0, q, v), Status::ok);
  ASSERT_EQ(run.integrator->advance(0.1), Status::ok) << run.integrator->failure();
  EXPECT_LE(PointPendulum::violation(run.integrator->q()), 1e-12);
}

}  // namespace tress::test_constraints
