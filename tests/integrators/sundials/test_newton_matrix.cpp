#include <gtest/gtest.h>

#include <random>

#include "integrators/catalogue.h"
#include "integrators/sundials/dae_newton.h"
#include "integrators/sundials/first_order.h"
#include "tests/support/small_systems.h"

namespace tress::test_newton_matrix {

using namespace integrators;

using namespace testing_support;
using Vector = std::vector<double>;

// Central differences with step e err by e^2 + eps / e = 1e-10, times the size of the
// entries (up to cj g, gamma^-1: 1e2); the forward difference inside solve() by 1e-8
// times the same.
constexpr double difference_step = 1e-5;
constexpr double allowed = 1e-5;

Vector random(std::size_t n, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector x(n);
  for (double& entry : x) entry = uniform(generator);
  return x;
}

Vector plus(const Vector& x, double factor, const Vector& d) {
  Vector y = x;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * d[i];
  return y;
}

void expect_equal(const Vector& a, const Vector& b) {
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], allowed) << i;
}

// Solves with the matrix at a random state (on no constraint, no equation satisfied) and
// multiplies the answer by the derivative of F taken from F alone.
void expect_dae_matrix(System& system, Formulation formulation) {
  Options options;
  options.formulation = formulation;
  options.alpha = 3;
  options.beta = 2;
  DaeForm form(system, options);
  std::unique_ptr<DaeNewton> newton;
  if (form.m == 0) {
    newton = std::make_unique<EliminatedNewton>(form);
  } else {
    newton = std::make_unique<AssembledNewton>(form, options);
  }
  const std::size_t length =
      2 * form.n + static_cast<std::size_t>(DaeForm::multipliers(system, formulation));
  const Vector y = random(length, 1), y_dot = random(length, 2), b = random(length, 3);
  const double cj = 7;
  ASSERT_EQ(newton->factor(0, y, y_dot, cj), Status::ok);
  Vector x = b;
  ASSERT_EQ(newton->solve(x), Status::ok);

  const auto moved = [&](double e) {
    Vector f(length);
    EXPECT_EQ(form.residual(0, plus(y, e, x), plus(y_dot, e * cj, x), f), Status::ok);
    return f;
  };
  const double e = difference_step;
  Vector product = plus(moved(e), -1, moved(-e));
  for (double& entry : product) entry /= 2 * e;
  expect_equal(product, b);
}

TEST(DaeNewton, IsTheDerivativeOfTheResidual_Unconstrained) {
  AngleChain chain(3);
  expect_dae_matrix(chain, Formulation::parametric);
  AnglePendulum pendulum;
  expect_dae_matrix(pendulum, Formulation::parametric);
}

TEST(DaeNewton, IsTheDerivativeOfTheResidual_Constrained) {
  PointPendulum system;
  for (const Formulation formulation : {Formulation::acceleration, Formulation::baumgarte,
                                        Formulation::index2_ggl, Formulation::index3}) {
    SCOPED_TRACE(name(formulation));
    expect_dae_matrix(system, formulation);
  }
}

/// y - gamma f(t, y) = known, from a guess that is off by a tenth.
void expect_implicit_solution(System& system, Formulation formulation) {
  Options options;
  options.formulation = formulation;
  options.alpha = 3;
  options.beta = 2;
  options.atol = options.rtol = 1e-8;
  FirstOrder equations(system, options);
  const std::size_t length = 2 * static_cast<std::size_t>(system.layout().coordinates);
  const double gamma = 0.03;
  const auto rate = [&](const Vector& at) {
    Vector y_dot(length);
    EXPECT_EQ(equations.rate(0, at, y_dot), Status::ok);
    return y_dot;
  };
  const Vector solution = random(length, 1);
  const Vector known = plus(solution, -gamma, rate(solution));
  Vector y = plus(solution, 0.1, random(length, 3));
  (void)rate(y);  // overwrites what the model has factored
  ASSERT_EQ(equations.solve(0, known, gamma, y), Status::ok);
  EXPECT_GT(equations.work().newton_iterations, 1);
  expect_equal(y, solution);
}

TEST(FirstOrder, SolvesTheImplicitEquations_Unconstrained) {
  for (const bool offered : {false, true}) {
    AngleChain chain(3);
    chain.offers_sparse_form = offered;
    expect_implicit_solution(chain, Formulation::parametric);
    AnglePendulum pendulum;
    pendulum.offers_explicit_form = offered;
    expect_implicit_solution(pendulum, Formulation::parametric);
  }
}

TEST(FirstOrder, SolvesTheImplicitEquations_Constrained) {
  PointPendulum system;
  for (const Formulation formulation :
       {Formulation::acceleration, Formulation::baumgarte, Formulation::projection}) {
    SCOPED_TRACE(name(formulation));
    expect_implicit_solution(system, formulation);
  }
}

}  // namespace tress::test_newton_matrix
