#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrators/stage/stage.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_stage {

using namespace integrators;
using namespace models;

using namespace testing_support;

CatalogueCase catalogue_case(std::string_view id, const char* key, const char* word) {
  return {&find_model(id), key, word};
}

/// A backward Euler step far too long for one Newton iteration.
constexpr double h = 0.03;

class StageSolution : public testing::TestWithParam<CatalogueCase> {
 protected:
  void SetUp() override {
    system_ = GetParam().make();
    state_.emplace(*system_);
    state_->v = state_->random(state_->v_typ);
    if (state_->m > 0) options_.formulation = Formulation::index3;
    q_bar_ = plus(state_->q, h, state_->v);
    a_.assign(state_->n, 0.0);
    lambda_.assign(state_->m, 0.0);
  }

  std::unique_ptr<System> system_;
  std::optional<States> state_;
  Options options_;
  const Weights w_{1, h, h* h};
  std::vector<double> q_bar_, a_, lambda_;
};

TEST_P(StageSolution, SatisfiesTheEquations) {
  Dynamics dynamics(*system_, options_);
  Stage stage(dynamics, options_);
  std::vector<double> r(state_->n), c(state_->m), r_start(state_->n), c_start(state_->m);
  ASSERT_EQ(dynamics.residual(h, q_bar_, state_->v, a_, lambda_, r_start, c_start),
            Status::ok);
  ASSERT_EQ(stage.solve(h, q_bar_, state_->v, w_, a_, lambda_), Status::ok);
  EXPECT_GT(dynamics.stats.newton_iterations, 2);
  ASSERT_EQ(dynamics.residual(h, stage.q(), stage.v(), a_, lambda_, r, c), Status::ok);
  // The last correction was at most newton_tolerance over the scales; Newton squares what
  // is left, so two digits of margin for the ratios between scales are plenty.
  EXPECT_LE(largest(r), 1e2 * options_.newton_tolerance * largest(r_start));
  if (state_->m > 0) {
    ASSERT_GT(scaled_norm(c_start, dynamics.g_typ()), 1e-6);
    EXPECT_LE(scaled_norm(c, dynamics.g_typ()), 1e-2 * options_.newton_tolerance);
  }
}

TEST_P(StageSolution, ConvergesQuadraticallyWithTheExactTangent) {
  Dynamics dynamics(*system_, options_);
  Stage stage(dynamics, options_);
  ASSERT_EQ(stage.solve(h, q_bar_, state_->v, w_, a_, lambda_), Status::ok);
  const std::vector<double> solution = a_;
  std::ranges::fill(a_, 0.0);
  std::ranges::fill(lambda_, 0.0);
  std::vector<double> errors;
  for (int i = 0; i < 12; ++i) {
    ASSERT_EQ(stage.single_step(h, q_bar_, state_->v, w_, a_, a_, lambda_), Status::ok);
    const double error = scaled_norm(plus(a_, -1, solution), state_->a_typ);
    if (error < 1e-9) break;  // the accuracy of the solution compared with
    errors.push_back(error);
  }
  // An error e below one becomes C e^2; a fixed fraction per iteration would be linear.
  ASSERT_GE(errors.size(), 2U);
  const double last = errors.back(), before = errors[errors.size() - 2];
  EXPECT_LE(last, 0.1 * before) << "before " << before;
  EXPECT_LE(last, 100 * before * before) << "before " << before;
}

INSTANTIATE_TEST_SUITE_P(
    Models, StageSolution,
    testing::Values(catalogue_case("double_pendulum", "", ""),
                    catalogue_case("bead_on_wire", "form", "implicit"),
                    catalogue_case("bead_on_wire", "curve", "helix"),
                    catalogue_case("inextensible_chain", "", ""),
                    catalogue_case("tinkertoys", "structure", "tree")),
    [](const auto& test) { return test.param.name(); });

// ---- where Newton's method alone does not converge ---------------------------------

/// One coordinate with r = inertia(q) a - force(q); derivatives by name.
struct ScalarData {
  double (*inertia)(double q), (*inertia_q)(double q);
  double (*force)(double q), (*force_q)(double q);
};

class Scalar final : public System {
 public:
  explicit Scalar(const ScalarData& data) : data_(data) {}
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {false, false}; }
  void initial_state(Out q, Out v) const override { q[0] = v[0] = 0; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double, In q, In, In a, Out r) noexcept override {
    r[0] = data_.inertia(q[0]) * a[0] - data_.force(q[0]);
    return Status::ok;
  }
  Status linearize(double, In q, In, In a, Weights w) noexcept override {
    s_ = w.acc * data_.inertia(q[0]) +
         w.pos * (data_.inertia_q(q[0]) * a[0] - data_.force_q(q[0]));
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / s_;
    return Status::ok;
  }

 private:
  ScalarData data_;
  double s_ = 1;
};

double none(double) { return 0; }

/// Solves force(q) = 0 with q = q_bar + a, v = v_bar + a, from the guess a.
struct Solved {
  Status status;
  double q;
};
Solved solved(const ScalarData& data, double q_bar, double v_bar, double a) {
  Scalar system(data);
  const Options options;
  Dynamics dynamics(system, options);
  Stage stage(dynamics, options);
  const std::vector<double> bar{q_bar}, v{v_bar};
  std::vector<double> guess{a}, lambda;
  const Status s = stage.solve(0, bar, v, {1, 1, 1}, guess, lambda);
  return {s, stage.q()[0]};
}

// With the derivative of force taken 10 % too small every correction is 0.053 of the one
// before: |1 - 2/1.9|.
class StageThatLearns : public testing::Test {
 protected:
  static constexpr double tolerance = 1e-2;

  StageThatLearns() {
    options_.newton_tolerance = tolerance;
    options_.refresh = Refresh::every_step;
  }

  long corrections(Stage& stage, double q_bar, Stage::Matrix matrix) {
    const long before = dynamics_.stats.newton_iterations;
    const std::vector<double> bar{q_bar}, v{0};
    std::vector<double> a{0}, lambda;
    EXPECT_EQ(stage.solve(0, bar, v, {1, 1, 1}, a, lambda, matrix), Status::ok);
    EXPECT_NEAR(a[0], -q_bar / 2, tolerance);
    error_ = std::abs(a[0] + q_bar / 2);
    return dynamics_.stats.newton_iterations - before;
  }

  Scalar system_{{[](double) { return 1.0; }, none, [](double q) { return -q; },
                  [](double) { return -0.9; }}};
  Options options_;
  Dynamics dynamics_{system_, options_};
  double error_ = 0;
};

TEST_F(StageThatLearns, ImprovesTheMatrixThatStagesShare) {
  Stage stage(dynamics_, options_, {.remaining = 1, .learns = true});
  // The second correction sees how far the first was off: of one unknown that is all.
  EXPECT_EQ(corrections(stage, 1, Stage::Matrix::own), 2);
  EXPECT_LT(error_, 1e-14);
  EXPECT_EQ(corrections(stage, 0.1, Stage::Matrix::shared), 2);
  EXPECT_LT(error_, 1e-14);
}

/// The rate of the stage before would allow it: it is not that of other directions.
TEST_F(StageThatLearns, DoesNotEndAfterOneCorrectionByTheRateOfAnotherStage) {
  Stage stage(dynamics_, options_, {.remaining = 1, .learns = true});
  EXPECT_EQ(corrections(stage, 1, Stage::Matrix::own), 2);
  EXPECT_EQ(corrections(stage, 0.1, Stage::Matrix::shared), 2);
  EXPECT_EQ(corrections(stage, 0.1, Stage::Matrix::own), 2);
}

TEST_F(StageThatLearns, OthersDoNot) {
  Stage stage(dynamics_, options_, {.remaining = 1});
  EXPECT_EQ(corrections(stage, 1, Stage::Matrix::own), 2);
  EXPECT_GT(error_, 1e-4);
  EXPECT_EQ(corrections(stage, 0.1, Stage::Matrix::shared), 2);
  EXPECT_GT(error_, 1e-6);
}

// Newton's method on atan diverges from |q| > 1.392.
TEST(StageDamping, ConvergesWhereFullStepsOvershoot) {
  const ScalarData arctangent{none, none, [](double q) { return std::atan(q); },
                              [](double q) { return 1 / (1 + q * q); }};
  const Solved result = solved(arctangent, 10, 0, 0);
  EXPECT_EQ(result.status, Status::ok);
  // The last correction is at most the tolerance.
  EXPECT_LE(std::abs(result.q), Options{}.newton_tolerance);
}

// q^3 - 2 q + 2 falls to 0.911 at q = 0.816 and no further for q > 0; its one root is
// -1.76929. Newton's method goes 0, 1, 0, ... and every damped step ends at the minimum.
TEST(StageDamping, BeginsAnewWhereTheGuessLeadsNowhere) {
  const ScalarData cubic{none, none, [](double q) { return q * q * q - 2 * q + 2; },
                         [](double q) { return 3 * q * q - 2; }};
  constexpr double root = -1.7692923542386314;
  const Solved no_acceleration = solved(cubic, -3, -5, 4);  // from q = 1, -3, 2
  EXPECT_EQ(no_acceleration.status, Status::ok);
  EXPECT_NEAR(no_acceleration.q, root, 1e-9);
  const Solved standstill = solved(cubic, 1, 3, 0);  // from q = 1, 1, -2
  EXPECT_EQ(standstill.status, Status::ok);
  EXPECT_NEAR(standstill.q, root, 1e-9);
  const ScalarData square{none, none, [](double q) { return q * q + 1; },
                          [](double q) { return 2 * q; }};
  EXPECT_EQ(solved(square, 1, -1, 0).status, Status::retry);
}

// a = -q with a derivative of -4 for -1: corrections shrink by 1 - 2/5 each.
TEST(StageIteration, GoesOnUnderALooseToleranceWhileCorrectionsShrink) {
  Scalar system({[](double) { return 1.0; }, none, [](double q) { return -q; },
                 [](double) { return -4.0; }});
  Options options;
  options.newton_tolerance = 1e-6;
  options.newton_iterations = 50;
  Dynamics dynamics(system, options);
  Stage stage(dynamics, options);
  const std::vector<double> bar{0.05}, v{0};
  std::vector<double> a{0}, lambda;
  ASSERT_EQ(stage.solve(0, bar, v, {1, 1, 1}, a, lambda), Status::ok);
  // The corrections to come are 0.6/0.4 of the last one, which is at most the tolerance.
  EXPECT_NEAR(stage.q()[0], 0.025, 1.5 * options.newton_tolerance);
}

double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }
double sigmoid_slope(double x) { return sigmoid(x) * (1 - sigmoid(x)); }

// a = F(q) with F = -12 that rises by 3 at q = 2 and by 3 more at 7.5: from 14, where the
// drift ends, and from 0, where it begins, Newton's method meets a minimum of |a - F|
// before the one solution, which is q = 5. As a step of a part s grows from s = 0, q
// passes 2 where s^2 F' is still small, and never comes near 7.5.
TEST(StageContinuation, FollowsTheMotionFromWhereTheStepBegins) {
  constexpr double width = 0.2;
  const ScalarData steep{
      [](double) { return 1.0; }, none,
      [](double q) {
        return -12 + 3 * sigmoid((q - 2) / width) + 3 * sigmoid((q - 7.5) / width);
      },
      [](double q) {
        return 3 / width *
               (sigmoid_slope((q - 2) / width) + sigmoid_slope((q - 7.5) / width));
      }};
  const Solved result = solved(steep, 14, 14, 0);
  EXPECT_EQ(result.status, Status::ok);
  EXPECT_NEAR(result.q, 5, 1e-4);  // what the rises leave there
}

double exponential(double q) { return std::exp(q); }

// a = exp(q) from rest: q = s^2 exp(q) for the part s of the step has solutions up to
// s^2 = 1/e, where q = 1, and none beyond.
TEST(StageContinuation, FindsWhereTheSolutionTurnsBack) {
  Scalar system({[](double) { return 1.0; }, none, exponential, exponential});
  const Options options;
  Dynamics dynamics(system, options);
  Stage stage(dynamics, options);
  const std::vector<double> bar{0};
  std::vector<double> a{0}, lambda;
  EXPECT_EQ(stage.solve(0, bar, bar, {1, 1, 1}, a, lambda), Status::retry);
  // The fold lies between two points a fifth apart at most, where the slope of the path
  // is taken to be linear.
  EXPECT_NEAR(dynamics.reached, std::exp(-0.5), 5e-3);
}

/// q = s^2 q/g(q), g = k (q^3/3 - 0.225 q^2 + 0.045 q): s^2 = g(q) rises up to q = 0.15,
/// falls up to 0.3 and rises again, through 1.
class TurnsTwice final : public System {
 public:
  explicit TurnsTwice(double k) : k_(k) {}
  static double g(double k, double q) { return k * q * over(q); }
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {}; }
  void initial_state(Out q, Out v) const override { q[0] = v[0] = 0; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double, In q, In, In a, Out r) noexcept override {
    r[0] = a[0] - 1 / (k_ * over(q[0]));
    return Status::ok;
  }
  Status linearize(double, In q, In, In, Weights w) noexcept override {
    s_ = w.acc + w.pos * (2 * q[0] / 3 - 0.225) / (k_ * over(q[0]) * over(q[0]));
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / s_;
    return Status::ok;
  }

 private:
  static double over(double q) { return q * q / 3 - 0.225 * q + 0.045; }
  double k_, s_ = 1;
};

// Without continuation two of these steps, at k = 54 and 91, end before the fold.
TEST(StageContinuation, PassesWhereTheSolutionTurnsBackTwice) {
  for (int k = 40; k < 100; ++k) {
    TurnsTwice system(k);
    const Options options;
    Dynamics dynamics(system, options);
    Stage stage(dynamics, options);
    const std::vector<double> bar{0};
    std::vector<double> a{0}, lambda;
    ASSERT_EQ(stage.solve(0, bar, bar, {1, 1, 1}, a, lambda), Status::ok) << k;
    // g' is below 10 at all these solutions, which are known to newton_tolerance.
    EXPECT_NEAR(TurnsTwice::g(k, stage.q()[0]), 1, 10 * options.newton_tolerance) << k;
  }
}

// ---- where the force jumps ---------------------------------------------------------

/// r = a - f(q) of two coordinates; f is (1, y^2) below the parabola x = y^2/10 and
/// (-2, y^2 - 1) above it.
class Jump final : public System {
 public:
  static double height(In q) { return q[0] - q[1] * q[1] / 10; }
  Layout layout() const override { return {2, 0}; }
  Traits traits() const override { return {false, false}; }
  void initial_state(Out q, Out v) const override { q[0] = q[1] = v[0] = v[1] = 0; }
  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::fill(q_typ, 1.0);
    std::ranges::fill(v_typ, 1.0);
  }
  Status residual(double, In q, In, In a, Out r) noexcept override {
    const bool above = height(q) > 0;
    r[0] = a[0] - (above ? -2 : 1);
    r[1] = a[1] - q[1] * q[1] + (above ? 1 : 0);
    return Status::ok;
  }
  Status linearize(double, In q, In, In, Weights w) noexcept override {
    s_ = w.acc - 2 * w.pos * q[1];
    acc_ = w.acc;
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / acc_;
    x[1] = b[1] / s_;
    return Status::ok;
  }

 private:
  double s_ = 1, acc_ = 1;
};

// From q_bar = (0.5, 0.1) neither force leads to its own side of the parabola: the
// solution lies on it, under a mean of both.
TEST(StageJump, IsSolvedByAMeanOfBothForces) {
  Jump system;
  const Options options;
  Dynamics dynamics(system, options);
  Stage stage(dynamics, options);
  const std::vector<double> q_bar{0.5, 0.1}, v_bar{0, 0};
  std::vector<double> a{0, 0}, lambda;
  const double length = 0.5;
  ASSERT_EQ(stage.solve(0, q_bar, v_bar, {1, length, length * length}, a, lambda),
            Status::ok);
  EXPECT_NEAR(Jump::height(stage.q()), 0, 1e-9);
  const double share = (1 - a[0]) / 3;  // of the force above
  EXPECT_GT(share, 0);
  EXPECT_LT(share, 1);
  const double y = stage.q()[1];
  EXPECT_NEAR(a[1], y * y - share, 1e-9 / (length * length));
}

// One Newton step from a = 0 is force / (inertia + h^2 inertia' a_matrix).
TEST(StageSingleStep, TakesItsMatrixAtTheAccelerationGiven) {
  Scalar system({[](double q) { return 1 + q * q; }, [](double q) { return 2 * q; },
                 [](double) { return 3.0; }, none});
  const Options options;
  Dynamics dynamics(system, options);
  Stage stage(dynamics, options);
  const std::vector<double> q_bar{0.5}, v{0}, a_matrix{4};
  std::vector<double> a{0}, lambda;
  ASSERT_EQ(stage.single_step(0, q_bar, v, {1, 0.5, 0.25}, a_matrix, a, lambda),
            Status::ok);
  EXPECT_DOUBLE_EQ(a[0], 3 / (1.25 + 0.25 * 2 * 0.5 * 4));
  EXPECT_DOUBLE_EQ(stage.q()[0], 0.5 + 0.25 * a[0]);
}

}  // namespace tress::test_stage
