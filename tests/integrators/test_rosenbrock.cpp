#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "integrators/one_step/rodas5p.h"
#include "tests/support/double_pendulum.h"

namespace tress::test_rosenbrock {

using namespace integrators;

constexpr std::size_t n = RosenbrockTable::most_stages;
using Column = std::array<double, n>;
using Matrix = std::array<Column, n>;

/// Inverse of a lower triangular matrix.
Matrix inverse(const Matrix& x) {
  Matrix y{};
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double sum = i == j ? 1 : 0;
      for (std::size_t k = j; k < i; ++k) sum -= x[i][k] * y[k][j];
      y[i][j] = sum / x[i][i];
    }
  }
  return y;
}

Matrix operator*(const Matrix& x, const Matrix& y) {
  Matrix product{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < n; ++j) product[i][j] += x[i][k] * y[k][j];
    }
  }
  return product;
}

Column operator*(const Matrix& x, const Column& y) {
  Column product{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) product[i] += x[i][j] * y[j];
  }
  return product;
}

Column operator*(const Column& x, const Column& y) {
  Column product{};
  for (std::size_t i = 0; i < n; ++i) product[i] = x[i] * y[i];
  return product;
}

/// The coefficients in the form with products by the Jacobian: the sums of increments
/// `alpha`, those of the Jacobian gamma, beta = alpha + gamma, and both sets of weights.
struct Form {
  Matrix alpha{}, gamma{}, beta{}, omega{};
  Column b{}, embedded{}, time{}, rate{};

  explicit Form(const RosenbrockTable& table) {
    Matrix reciprocal{};  // of gamma: I/gamma_ii - C
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) reciprocal[i][j] = -table.c[i][j];
      reciprocal[i][i] = 1 / table.gamma;
    }
    gamma = inverse(reciprocal);
    alpha = table.a * gamma;
    Matrix weights{};
    weights[0] = weights[1] = table.a[n - 1];
    weights[0][n - 1] = 1;
    weights = weights * gamma;
    b = weights[0];
    embedded = weights[1];
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        beta[i][j] = alpha[i][j] + gamma[i][j];
        time[i] += alpha[i][j];
        rate[i] += gamma[i][j];
      }
    }
    omega = inverse(beta);
  }
};

/// Largest violation of the conditions of this order by these weights. [Hairer, Wanner
/// 1996, Solving ODEs II, table IV.7.1, with beta_ij including the diagonal]
double violation(const Form& form, const Column& weights, int order) {
  Column one;
  one.fill(1);
  const Column a = form.alpha * one, b = form.beta * one;
  const Matrix &al = form.alpha, &be = form.beta;
  const Column a2 = a * a, bb = be * b;
  double worst = 0;
  const auto lacks = [&](const Column& x, double exact) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += weights[i] * x[i];
    worst = std::max(worst, std::abs(sum - 1 / exact));
  };
  switch (order) {
    case 1:
      lacks(one, 1);
      break;
    case 2:
      lacks(b, 2);
      break;
    case 3:
      lacks(a2, 3), lacks(bb, 6);
      break;
    case 4:
      lacks(a2 * a, 4), lacks(a * (al * b), 8), lacks(be * a2, 12), lacks(be * bb, 24);
      break;
    default:
      lacks(a2 * a2, 5), lacks(a2 * (al * b), 10), lacks((al * b) * (al * b), 20);
      lacks(a * (al * a2), 15), lacks(a * (al * bb), 30), lacks(be * (a2 * a), 20);
      lacks(be * (a * (al * b)), 40), lacks(be * (be * a2), 60);
      lacks(be * (be * bb), 120);
  }
  return worst;
}

// Sixteen published digits of coefficients up to 150, which cancel in sums of eight.
constexpr double rounding = 1e-12;

TEST(Rodas5p, SatisfiesTheOrderConditionsAndNoMore) {
  const Form form(rodas5p_table());
  for (int order = 1; order <= 5; ++order) {
    EXPECT_LE(violation(form, form.b, order), rounding) << order;
    if (order <= 4) {
      EXPECT_LE(violation(form, form.embedded, order), rounding) << order;
    }
  }
  EXPECT_GT(violation(form, form.embedded, 5), 1e-4);
}

// Two conditions of equations of index 1 [Hairer, Wanner 1996, Solving ODEs II, section
// VI.4], which no condition above implies.
TEST(Rodas5p, SatisfiesConditionsOfIndexOne) {
  const Form form(rodas5p_table());
  Column one;
  one.fill(1);
  const Column a = form.alpha * one, b = form.beta * one;
  const auto sum = [&](const Column& x) {
    double total = 0;
    for (std::size_t i = 0; i < n; ++i) total += form.b[i] * x[i];
    return total;
  };
  EXPECT_NEAR(sum(form.omega * (a * a)), 1, rounding);
  EXPECT_NEAR(sum(form.omega * (a * a * a)), 1, rounding);
  EXPECT_NEAR(sum(form.omega * (a * (form.alpha * b))), 1. / 2, rounding);
}

TEST(Rodas5p, HasTheTimesAndRatesOfItsCoefficients) {
  const RosenbrockTable& table = rodas5p_table();
  const Form form(table);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(form.time[i], table.time[i], rounding) << i;
    EXPECT_NEAR(form.rate[i], table.rate[i], rounding) << i;
  }
}

/// y_1/y_0 for y' = z y with step 1.
std::complex<double> growth(const Form& form, double gamma, std::complex<double> z) {
  std::array<std::complex<double>, n> k;
  std::complex<double> sum = 1;
  for (std::size_t i = 0; i < n; ++i) {
    std::complex<double> known = 1;
    for (std::size_t j = 0; j < i; ++j) known += z * form.beta[i][j] * k[j];
    k[i] = known / (1. - z * gamma);
    sum += z * form.b[i] * k[i];
  }
  return sum;
}

TEST(Rodas5p, IsLStable) {
  const Form form(rodas5p_table());
  const double gamma = rodas5p_table().gamma;
  EXPECT_LE(std::abs(growth(form, gamma, -1e9)), 1e-7);
  for (double y = 1e-3; y < 1e6; y *= 1.1) {
    EXPECT_LE(std::abs(growth(form, gamma, {0, y})), 1 + rounding) << y;
  }
}

// Differences for the products with the Jacobian leave no floor: forces are quadratic in
// velocity.
TEST(Rodas5p, KeepsItsOrderWithAVariableMassDownToRounding) {
  EXPECT_LE(testing_support::expect_order_on_double_pendulum("rodas5p", {},
                                                             {150, 300, 600, 1200}, 4.75),
            1e-11);
}

}  // namespace tress::test_rosenbrock
