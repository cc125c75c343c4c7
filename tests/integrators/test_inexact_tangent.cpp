#include <gtest/gtest.h>

#include "experiments/numerics/fit.h"
#include "tests/support/drive.h"
#include "tests/support/small_systems.h"

namespace tress::test_inexact_tangent {

using namespace experiments;

using testing_support::AngleChain;
using testing_support::Drive;

/// Centrifugal forces and weight stay out of S.
class MassTangent final : public AngleChain {
 public:
  using AngleChain::AngleChain;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return AngleChain::linearize(t, q, v, a, {w.acc, 0, 0});
  }
};

/// a = t, with a tangent that is a quarter too large.
class Ramp final : public System {
 public:
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override { q[0] = v[0] = 0; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double t, In, In, In a, Out r) noexcept override {
    r[0] = a[0] - t;
    return Status::ok;
  }
  Status linearize(double, In, In, In, Weights) noexcept override { return Status::ok; }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / 1.25;
    return Status::ok;
  }
};

constexpr int links = 3;
constexpr double end_time = 1;  // s: the chain has swung through

std::vector<double> reference() {
  AngleChain chain(links);
  Options options;
  options.rtol = options.atol = 1e-12;
  Drive drive("gsl_rk8pd", chain, options);
  EXPECT_EQ(drive.to(end_time), Status::ok) << drive.integrator->failure();
  return {drive.integrator->q().begin(), drive.integrator->q().end()};
}

TEST(LinearlyImplicitMidpoint, KeepsOrderTwoWithTheMassMatrixForATangent) {
  const std::vector<double> exact = reference();
  std::vector<double> steps, errors;
  for (const int count : {200, 400, 800, 1600}) {
    MassTangent chain(links);
    Options options;
    options.step = end_time / count;
    Drive drive("linearly_implicit_midpoint", chain, options);
    ASSERT_EQ(drive.to(end_time), Status::ok) << drive.integrator->failure();
    steps.push_back(options.step);
    errors.push_back(drive.distance(exact));
  }
  // A single step from no acceleration would be of order 1.
  EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.2)
      << "errors from " << errors.front() << " to " << errors.back();
}

TEST(LinearlyImplicitMidpoint, TakesOneSolveAStepAfterTheFirstTwo) {
  AngleChain chain(links);
  Options options;
  options.step = 0.01;
  Drive drive("linearly_implicit_midpoint", chain, options);
  ASSERT_EQ(drive.to(0.02), Status::ok);
  const Stats before = drive.integrator->stats();
  ASSERT_EQ(drive.to(end_time), Status::ok);
  const Stats after = drive.integrator->stats();
  const long count = after.steps - before.steps;
  EXPECT_EQ(count, 98);
  EXPECT_EQ(after.residuals - before.residuals, count);
  EXPECT_EQ(after.linearizations - before.linearizations, count);
  EXPECT_EQ(after.solves - before.solves, count);
}

TEST(LinearlyImplicitMidpoint, ExtrapolatesOverUnequalSteps) {
  Ramp ramp;
  Options options;
  options.step = 1;
  Drive drive("linearly_implicit_midpoint", ramp, options);
  double t = 0;
  for (const double h : {0.1, 0.2, 0.05, 0.4, 0.4, 0.1}) {
    t += h;
    ASSERT_EQ(drive.to(t), Status::ok);
  }
  // The midpoint rule is exact here, and so is a line through two accelerations; the
  // first two steps iterate to 1e-10 of v.
  EXPECT_NEAR(drive.integrator->v()[0], t * t / 2, 1e-9);
}

}  // namespace tress::test_inexact_tangent
