#include <gtest/gtest.h>

#include "experiments/numerics/fit.h"
#include "integrators/integrator_options.h"
#include "tests/support/drive.h"
#include "tests/support/small_systems.h"

namespace tress::test_accuracy {

using namespace experiments;

using namespace testing_support;

struct Case {
  std::string id;
  int max_order = 0;
  std::string table = {};

  std::string name() const {
    return id + (max_order > 0 ? "_order_" + std::to_string(max_order) : "") +
           (table.empty() ? "" : "_" + table);
  }
};

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return info.param.name();
}

Options options_of(const Case& chosen, double tolerance) {
  Options options;
  options.rtol = options.atol = tolerance;
  options.max_order = chosen.max_order;
  if (!chosen.table.empty()) apply(options, "table", chosen.table, "test");
  return options;
}

// Fine RK4 as reference: error C h^4 with C of order 1, so 1e-14 at 1e-4 s and below the
// 1e-11 that the tightest comparison needs.
template <class Pendulum>
std::vector<double> reference(Pendulum&& system, double t_end) {
  Options options;
  options.step = 1e-4;
  Drive run("rk4", system, options);
  EXPECT_EQ(run.to(t_end), Status::ok) << run.integrator->failure();
  return {run.integrator->q().begin(), run.integrator->q().end()};
}

constexpr double duration = 2;  // s: about one period

class Accuracy : public testing::TestWithParam<Case> {
 protected:
  template <class System>
  double error(System& system, double tolerance, In expected, double t_end) {
    Drive run(GetParam().id, system, options_of(GetParam(), tolerance));
    EXPECT_EQ(run.to(t_end), Status::ok) << run.integrator->failure();
    return run.distance(expected);
  }

  // The error per step is rtol, so a method of order p collects rtol^{p/(p+1)}: at order
  // 2 it may leave 100 rtol behind at tight tolerances; 100 rtol^{2/3} it must keep.
  double allowed(double tolerance) const {
    const bool second_order = GetParam().id == "cvode_bdf" && GetParam().max_order <= 2;
    return second_order ? 100 * std::pow(tolerance, 2.0 / 3) : 100 * tolerance;
  }

  template <class System>
  void expect_to_follow_tolerance(System& system, In expected, double t_end) {
    std::vector<double> tolerances, errors;
    for (double tolerance = 1e-4; tolerance > 0.9e-9; tolerance /= 10) {
      tolerances.push_back(tolerance);
      errors.push_back(error(system, tolerance, expected, t_end));
      EXPECT_LE(errors.back(), allowed(tolerance)) << "rtol " << tolerance;
    }
    // Errors at one time scatter and may cancel, so the trend is what must hold:
    // rtol^(2/3) at order 2, nearly rtol above.
    EXPECT_GT(log_log_slope(tolerances, errors), 0.6);
    EXPECT_LT(errors.back(), 1e-3 * errors.front());
  }
};

TEST_P(Accuracy, OfThePendulum_FollowsTheTolerance) {
  for (const bool explicit_form : {true, false}) {
    AnglePendulum system;
    system.offers_explicit_form = explicit_form;
    expect_to_follow_tolerance(system, reference(system, duration), duration);
  }
}

TEST_P(Accuracy, OfAChainWithMovingMass_FollowsTheTolerance) {
  for (const bool sparse_form : {false, true}) {
    AngleChain system(3);
    system.offers_sparse_form = sparse_form;
    expect_to_follow_tolerance(system, reference(system, 1), 1);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sundials, Accuracy,
    testing::Values(Case{"cvode_adams"}, Case{"cvode_adams", 4}, Case{"cvode_bdf"},
                    Case{"cvode_bdf", 5}, Case{"arkode_erk"}, Case{"arkode_erk", 3},
                    Case{"arkode_erk", 8}, Case{"arkode_dirk"}, Case{"arkode_dirk", 5},
                    Case{"arkode_dirk", 0, "ARKODE_ESDIRK547L2SA_7_4_5"}, Case{"ida"}),
    case_name);

class Stiff : public testing::TestWithParam<Case> {};

// Rates of 1e4 / s for 3 s would take an explicit method 1e4 steps and more; an A-stable
// one with a right Newton matrix does not see them.
TEST_P(Stiff, FollowerOnItsSlowMotion_TakesFewSteps) {
  StiffFollower system;
  const StiffFollower::State exact = StiffFollower::exact(3);
  Drive run(GetParam().id, system, options_of(GetParam(), 1e-6));
  ASSERT_EQ(run.to(3), Status::ok) << run.integrator->failure();
  EXPECT_LE(run.distance(exact.q), 1e-4);
  const Stats stats = run.integrator->stats();
  EXPECT_LE(stats.steps, 500);
  EXPECT_LE(stats.rejected, 50);
}

INSTANTIATE_TEST_SUITE_P(Sundials, Stiff,
                         testing::Values(Case{"cvode_bdf"}, Case{"arkode_dirk"},
                                         Case{"ida"}),
                         case_name);

class Newton : public testing::TestWithParam<Case> {};

// A right matrix needs about one correction a step (or stage) and the next to see that it
// was enough, and one or two more when it is kept; a wrong one converges slowly or not at
// all.
TEST_P(Newton, MatrixIsRightAndRebuiltOnlyWhenNeeded) {
  AngleChain system(3);
  system.offers_sparse_form = true;
  Options options = options_of(GetParam(), 1e-6);
  const auto newton_work = [&] {
    Drive run(GetParam().id, system, options);
    EXPECT_EQ(run.to(1), Status::ok) << run.integrator->failure();
    Stats stats = run.integrator->stats();
    // Rates of the ODE form (and initial ones) also factor and solve, once each.
    stats.linearizations -= stats.solves - stats.newton_iterations;
    return stats;
  };
  options.refresh = Refresh::when_slow;
  const Stats lazy = newton_work();
  const long stages = GetParam().id == "arkode_dirk" ? 5 : 1;
  EXPECT_LE(lazy.newton_iterations, 4 * stages * (lazy.steps + lazy.rejected));
  EXPECT_LE(lazy.linearizations, lazy.newton_iterations / 5);

  options.refresh = Refresh::every_step;
  const Stats eager = newton_work();
  EXPECT_GT(eager.linearizations, lazy.linearizations);
}

TEST_P(Newton, CoefficientTightensTheCorrections) {
  AngleChain system(3);
  const auto iterations = [&](double coefficient) {
    Options options = options_of(GetParam(), 1e-6);
    options.newton_coefficient = coefficient;
    Drive run(GetParam().id, system, options);
    EXPECT_EQ(run.to(1), Status::ok) << run.integrator->failure();
    return static_cast<double>(run.integrator->stats().newton_iterations) /
           static_cast<double>(run.integrator->stats().steps);
  };
  EXPECT_GT(iterations(1e-5), iterations(0));
}

INSTANTIATE_TEST_SUITE_P(Sundials, Newton,
                         testing::Values(Case{"cvode_bdf"}, Case{"arkode_dirk"},
                                         Case{"ida"}),
                         case_name);

}  // namespace tress::test_accuracy
