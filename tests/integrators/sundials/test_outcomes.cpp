#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "integrators/integrator_options.h"
#include "tests/support/drive.h"
#include "tests/support/small_systems.h"

namespace tress::test_outcomes {

using namespace integrators;

using namespace testing_support;
using testing::HasSubstr;

class Sundials : public testing::TestWithParam<const char*> {
 protected:
  AnglePendulum system_;
  Options options_;
};

INSTANTIATE_TEST_SUITE_P(All, Sundials,
                         testing::Values("cvode_adams", "cvode_bdf", "arkode_erk",
                                         "arkode_dirk", "ida"),
                         [](const testing::TestParamInfo<const char*>& chosen) {
                           return std::string(chosen.param);
                         });

TEST_P(Sundials, LandsExactlyOnEveryEnd) {
  Drive run(GetParam(), system_, options_);
  double t = 0;
  for (const double stretch : {0.1, 1e-7, 1e-17, 0.3, 0.0}) {
    t += stretch;
    ASSERT_EQ(run.to(t), Status::ok) << run.integrator->failure();
    EXPECT_EQ(run.integrator->time(), t);
  }
}

// Cutting the way into stretches costs accuracy only within the tolerance.
TEST_P(Sundials, ManyEndsAndOneEndAgree) {
  Drive whole(GetParam(), system_, options_), cut(GetParam(), system_, options_);
  ASSERT_EQ(whole.to(1), Status::ok);
  for (int i = 1; i <= 20; ++i) ASSERT_EQ(cut.to(i / 20.0), Status::ok);
  EXPECT_LE(whole.distance(cut.integrator->q()), 200 * options_.rtol);
}

TEST_P(Sundials, RestartRepeatsTheRunBitForBit) {
  Drive run(GetParam(), system_, options_);
  ASSERT_EQ(run.to(1), Status::ok);
  const double first = run.integrator->q()[0];
  const Stats counted = run.integrator->stats();
  ASSERT_EQ(run.integrator->start(0, run.q0, run.v0), Status::ok);
  EXPECT_EQ(run.integrator->time(), 0);
  EXPECT_EQ(run.integrator->stats().steps, 0);
  EXPECT_EQ(run.integrator->stats().newton_iterations, 0);
  ASSERT_EQ(run.to(1), Status::ok);
  EXPECT_EQ(run.integrator->q()[0], first);
  EXPECT_EQ(run.integrator->stats().steps, counted.steps);
  EXPECT_EQ(run.integrator->stats().solves, counted.solves);
  EXPECT_EQ(run.integrator->stats().residuals, counted.residuals);
}

TEST_P(Sundials, ObserverSeesEveryStepAndCanStop) {
  Drive run(GetParam(), system_, options_);
  long seen = 0;
  double last = 0;
  ASSERT_EQ(run.to(0.5,
                   [&](double t, In q, In) {
                     EXPECT_GT(t, last);
                     EXPECT_EQ(q[0], run.integrator->q()[0]);
                     last = t;
                     ++seen;
                     return true;
                   }),
            Status::ok);
  EXPECT_EQ(seen, run.integrator->stats().steps);
  EXPECT_EQ(last, 0.5);
  EXPECT_EQ(run.to(1, [](double, In, In) { return false; }), Status::fatal);
  EXPECT_THAT(run.integrator->failure(), HasSubstr("stopped"));
}

TEST_P(Sundials, MaxStepIsKept) {
  options_.max_step = 0.01;
  Drive run(GetParam(), system_, options_);
  double last = 0, longest = 0;
  ASSERT_EQ(run.to(0.5,
                   [&](double t, In, In) {
                     longest = std::max(longest, t - last);
                     last = t;
                     return true;
                   }),
            Status::ok);
  EXPECT_LE(longest, 0.01 * (1 + 1e-9));
}

TEST_P(Sundials, MaxStepsExceededIsAFailureWithItsTime) {
  options_.max_steps = 5;
  Drive run(GetParam(), system_, options_);
  EXPECT_EQ(run.to(10), Status::fatal);
  EXPECT_EQ(run.integrator->stats().steps, 5);
  EXPECT_THAT(run.integrator->failure(), HasSubstr("max_steps = 5"));
  EXPECT_THAT(run.integrator->failure(), HasSubstr(std::string(GetParam()) + " at t = "));
  EXPECT_EQ(run.integrator->advance(20), Status::fatal);  // until started again
  ASSERT_EQ(run.integrator->start(0, run.q0, run.v0), Status::ok);
  EXPECT_EQ(run.integrator->failure(), "");
}

TEST_P(Sundials, ModelThatGivesUpEndsTheRunWithAReasonAndWithoutPrinting) {
  system_.fails_after = 0.5;
  system_.failure = Status::fatal;
  Drive run(GetParam(), system_, options_);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  EXPECT_EQ(run.to(1), Status::fatal);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_LE(run.integrator->time(), 0.5);
  EXPECT_THAT(run.integrator->failure(), HasSubstr("_FAIL"));
}

// A model that cannot go further asks for smaller steps forever.
TEST_P(Sundials, ModelThatOnlyRetriesEndsTheRunSoon) {
  system_.fails_after = 0.5;
  system_.failure = Status::retry;
  Drive run(GetParam(), system_, options_);
  EXPECT_EQ(run.to(1), Status::fatal);
  EXPECT_LE(run.integrator->time(), 0.5);
  EXPECT_LE(run.integrator->stats().steps, 5000);
  EXPECT_THAT(run.integrator->failure(),
              HasSubstr(std::string(GetParam()) + " at t = 0."));
}

// The model refuses leaps that rtol would allow: at least 1 s / 0.02 s steps, some of
// them after a refusal.
TEST_P(Sundials, RetryIsAnsweredBySmallerSteps) {
  system_.longest_leap = 0.02;
  options_.rtol = options_.atol = 1e-3;
  Drive run(GetParam(), system_, options_);
  ASSERT_EQ(run.to(1,
                   [&](double t, In, In) {
                     system_.leaps_from = t;
                     return true;
                   }),
            Status::ok)
      << run.integrator->failure();
  EXPECT_GE(run.integrator->stats().steps, 50);
  EXPECT_GE(run.integrator->stats().rejected, 1);
}

TEST_P(Sundials, AcceptThatChangesTheStateRestartsTheMethod) {
  system_.bounces = true;
  Drive run(GetParam(), system_, options_);
  const auto energy = [](In q, In v) {
    return v[0] * v[0] / 2 + gravity * (1 - std::cos(q[0]));
  };
  double lowest = 1;
  ASSERT_EQ(run.to(2,
                   [&](double, In q, In) {
                     lowest = std::min(lowest, q[0]);
                     return true;
                   }),
            Status::ok)
      << run.integrator->failure();
  // Quarter periods of about 0.54 s: down at 0.54, up at 1.07, down at 1.6.
  EXPECT_GE(system_.bounced, 2);
  EXPECT_GT(run.integrator->q()[0], 0);
  // Reflection keeps the energy (9.81 (1 - cos 1) = 4.5), the method to its tolerance.
  EXPECT_NEAR(energy(run.integrator->q(), run.integrator->v()), energy(run.q0, run.v0),
              1000 * options_.rtol * 10);
  EXPECT_GT(run.integrator->stats().steps, 2);
  EXPECT_GT(lowest, -1);
}

TEST_P(Sundials, FormulationItLacksIsRefused) {
  PointPendulum system;
  options_.formulation = Formulation::rattle;
  EXPECT_THROW(find_integrator(GetParam()).make(system, options_), InputError);
}

TEST_P(Sundials, OrderItLacksIsRefused) {
  options_.max_order = 13;
  EXPECT_THROW(find_integrator(GetParam()).make(system_, options_), InputError);
}

TEST_P(Sundials, EndInThePastIsAFailure) {
  Drive run(GetParam(), system_, options_);
  ASSERT_EQ(run.to(0.1), Status::ok);
  EXPECT_EQ(run.to(0.05), Status::fatal);
  EXPECT_THAT(run.integrator->failure(), HasSubstr("past"));
}

TEST(ArkodeDirk, UnknownTableIsRefusedWithTheList) {
  AnglePendulum system;
  Options options;
  apply(options, "table", "ESDIRK", "test");
  try {
    make_integrator("arkode_dirk", system, options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ARKODE_ESDIRK436L2SA_6_3_4"));
  }
}

// The order of the default table against that of a second-order one, seen in the steps.
TEST(ArkodeDirk, TableIsUsed) {
  AnglePendulum system;
  Options options;
  options.rtol = options.atol = 1e-8;
  Drive standard("arkode_dirk", system, options);
  apply(options, "table", "ARKODE_SDIRK_2_1_2", "test");
  Drive second_order("arkode_dirk", system, options);
  ASSERT_EQ(standard.to(0.2), Status::ok);
  ASSERT_EQ(second_order.to(0.2), Status::ok);
  EXPECT_GT(second_order.integrator->stats().steps,
            5 * standard.integrator->stats().steps);
}

TEST(CvodeAdams, RefusesProjectionAndNamesWhoCan) {
  PointPendulum system;
  Options options;
  options.formulation = Formulation::projection;
  try {
    find_integrator("cvode_adams").make(system, options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cvode_bdf"));
  }
}

}  // namespace tress::test_outcomes
