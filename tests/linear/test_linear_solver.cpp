#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "linear/banded.h"
#include "linear/linear_solver.h"
#include "tests/linear/matrices.h"
#include "tests/support/dense.h"

namespace tress::test_linear_solver {

using testing_matrices::kind_name;
using testing_matrices::Random;
using testing_matrices::span_of;
using testing_matrices::Sparse;
using testing_matrices::sparse;

constexpr double eps = std::numeric_limits<double>::epsilon();

double condition_of(const Eigen::MatrixXd& a) {
  const Eigen::VectorXd s = testing_support::singular_values(a);
  return s(0) / s(s.size() - 1);
}

Eigen::MatrixXd poisson(int n) {
  Eigen::MatrixXd a = 2 * Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i + 1 < n; ++i) a(i, i + 1) = a(i + 1, i) = -1;
  return a;
}

/// Backward stability of LU [Higham 2002, thm 9.4]: |r| <= c n eps growth |A| |x|. Pivots
/// are kept while the growth stays below 1000; random matrices stay far below that.
void expect_solves(LinearSolver& solver, const Eigen::MatrixXd& a,
                   const Eigen::VectorXd& b, double growth = 1000) {
  Eigen::VectorXd x = b;
  ASSERT_EQ(solver.solve(span_of(x)), Status::ok);
  const double bound = static_cast<double>(a.rows()) * eps * growth *
                       a.lpNorm<Eigen::Infinity>() * static_cast<double>(a.rows()) *
                       x.lpNorm<Eigen::Infinity>();
  EXPECT_LE((a * x - b).lpNorm<Eigen::Infinity>(), bound);
  const Eigen::VectorXd reference = testing_support::dense_solve(a, b);
  EXPECT_LE((x - reference).norm(),
            static_cast<double>(a.rows()) * eps * growth * condition_of(a) * x.norm());
}

class Solver : public testing::TestWithParam<LinearKind> {
 protected:
  std::unique_ptr<LinearSolver> make(const Sparse& a) {
    return make_linear_solver(GetParam(), a.pattern);
  }
};

INSTANTIATE_TEST_SUITE_P(All, Solver,
                         testing::Values(LinearKind::automatic, LinearKind::klu,
                                         LinearKind::banded, LinearKind::dense),
                         kind_name);

TEST_P(Solver, AgreesWithDenseOnRandomUnsymmetricMatrices) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    for (int n : {1, 2, 7, 16, 17, 60}) {
      Eigen::MatrixXd a = random.thinned(n, n, 0.15);
      a.diagonal() += Eigen::VectorXd::Constant(n, 3.0);
      const Sparse s = sparse(a);
      const auto solver = make(s);
      ASSERT_EQ(solver->factor(s.values), Status::ok);
      expect_solves(*solver, a, random.vector(n));
    }
  }
}

TEST_P(Solver, AgreesWithDenseOnSaddlePointsWithZeroDiagonal) {
  Random random(3);
  const int n = 40, m = 15;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + m, n + m);
  a.topLeftCorner(n, n).diagonal().setConstant(0.5);
  const Eigen::MatrixXd g = random.matrix(m, n);
  a.topRightCorner(n, m) = -g.transpose();
  a.bottomLeftCorner(m, n) = g;
  const Sparse s = sparse(a);
  const auto solver = make(s);
  ASSERT_EQ(solver->factor(s.values), Status::ok);
  expect_solves(*solver, a, random.vector(n + m));
}

TEST_P(Solver, AgreesWithDenseOnPermutedBands) {
  Random random(4);
  const int n = 50;
  const std::vector<int> order = random.permutation(n);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - 2); j <= std::min(n - 1, i + 3); ++j) {
      a(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]) =
          random.normal();
    }
  }
  const Sparse s = sparse(a);
  const auto solver = make(s);
  ASSERT_EQ(solver->factor(s.values), Status::ok);
  expect_solves(*solver, a, random.vector(n));
}

TEST_P(Solver, RefactorsWithNewValuesOnTheSamePattern) {
  Random random(5);
  const int n = 40;
  const Eigen::MatrixXd shape =
      random.thinned(n, n, 0.1) + Eigen::MatrixXd::Identity(n, n);
  const auto solver = make(sparse(shape));
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::MatrixXd a = shape.cwiseProduct(random.matrix(n, n));
    a.diagonal().array() += 4;
    ASSERT_EQ(solver->factor(sparse(a, shape).values), Status::ok);
    expect_solves(*solver, a, random.vector(n));
  }
}

// The first matrix makes the diagonal the choice of pivots, the second leaves 1e-14
// there: without new pivots the growth of 1e14 would cost all digits but two.
TEST_P(Solver, ChoosesPivotsAnewWhenTheOldOnesGoBad) {
  Random random(6);
  const int n = 30;
  const Eigen::MatrixXd shape =
      random.thinned(n, n, 0.3) + 10 * Eigen::MatrixXd::Identity(n, n);
  const auto solver = make(sparse(shape));
  ASSERT_EQ(solver->factor(sparse(shape).values), Status::ok);
  Eigen::MatrixXd bad = shape;
  bad.diagonal().setConstant(1e-14);
  ASSERT_EQ(solver->factor(sparse(bad, shape).values), Status::ok);
  expect_solves(*solver, bad, random.vector(n));
  ASSERT_EQ(solver->factor(sparse(shape).values), Status::ok);
  expect_solves(*solver, shape, random.vector(n));
}

TEST_P(Solver, AsksForARetryWhenSingularAndRecovers) {
  Random random(7);
  const int n = 30;
  const Eigen::MatrixXd good = random.matrix(n, n);
  Eigen::MatrixXd singular = good;
  singular.col(11) = singular.col(3) - 2 * singular.col(20);
  const auto solver = make(sparse(good));
  EXPECT_EQ(solver->factor(sparse(singular).values), Status::retry);
  Eigen::VectorXd b = random.vector(n);
  EXPECT_EQ(solver->solve(span_of(b)), Status::retry);
  EXPECT_EQ(solver->condition(), std::numeric_limits<double>::infinity());
  ASSERT_EQ(solver->factor(sparse(good).values), Status::ok);
  expect_solves(*solver, good, random.vector(n));
}

TEST_P(Solver, AsksForARetryOnAStructurallySingularMatrix) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(20, 20);
  a(4, 4) = 0;
  a(4, 5) = 1;  // rows 4 and 5 share their only column
  const Sparse s = sparse(a);
  EXPECT_EQ(make(s)->factor(s.values), Status::retry);
}

TEST_P(Solver, AsksForARetryOnValuesThatAreNotFinite) {
  Sparse s = sparse(poisson(30));
  const auto solver = make(s);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(),
                     std::numeric_limits<double>::infinity()}) {
    std::vector<double> values = s.values;
    values[17] = bad;
    EXPECT_EQ(solver->factor(values), Status::retry);
  }
  ASSERT_EQ(solver->factor(s.values), Status::ok);
  Eigen::VectorXd b = Eigen::VectorXd::Ones(30);
  b(3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solver->solve(span_of(b)), Status::retry);
}

// Units are no singularity: the condition of the equilibrated matrix is that of
// Poisson's. The header promises its order of magnitude, so the bound on x carries a
// factor n.
TEST_P(Solver, IsBlindToTheUnitsOfTheUnknowns) {
  Random random(8);
  const int n = 40;
  const Eigen::VectorXd units = Eigen::VectorXd::NullaryExpr(
      n, [](Eigen::Index i) { return std::pow(10.0, (i * 7) % 25 - 12); });
  const Eigen::MatrixXd plain = poisson(n);
  const Sparse s = sparse(units.asDiagonal() * plain * units.asDiagonal());
  const auto solver = make(s);
  ASSERT_EQ(solver->factor(s.values), Status::ok);
  EXPECT_LE(solver->condition(), 1e3 * condition_of(plain));
  const Eigen::VectorXd expected = random.vector(n);
  Eigen::VectorXd x = units.asDiagonal() * (plain * expected);
  ASSERT_EQ(solver->solve(span_of(x)), Status::ok);
  x = units.asDiagonal() * x;
  EXPECT_LE((x - expected).norm(), n * n * eps * condition_of(plain) * expected.norm());
}

// Promise: 2-norm of the inverse from below up to sqrt(n) in the mean, times a 1-norm
// that exceeds the 2-norm by at most sqrt(n); the condition of poisson(n) is cot^2(pi /
// 2(n+1)).
TEST_P(Solver, ConditionHasTheRightOrderOfMagnitude) {
  for (int n : {10, 40, 160}) {
    const Sparse s = sparse(poisson(n));
    const auto solver = make(s);
    ASSERT_EQ(solver->factor(s.values), Status::ok);
    const double truth = std::pow(std::tan(M_PI / (2 * (n + 1))), -2);
    EXPECT_GE(solver->condition(), truth / n);
    EXPECT_LE(solver->condition(), truth * std::sqrt(n));
  }
  for (double small : {1e-3, 1e-6, 1e-9, 1e-12}) {
    Random random(9);
    const int n = 20;
    const Eigen::MatrixXd q = testing_support::orthogonal(random.matrix(n, n));
    Eigen::VectorXd spectrum = Eigen::VectorXd::Ones(n);
    spectrum(0) = small;
    const Eigen::MatrixXd a = q * spectrum.asDiagonal() * q.transpose();
    const Sparse s = sparse(a);
    const auto solver = make(s);
    ASSERT_EQ(solver->factor(s.values), Status::ok);
    EXPECT_GE(solver->condition(), 1e-3 / small);
    EXPECT_LE(solver->condition(), 1e3 / small);
  }
}

TEST(CuthillMcKee, FindsTheBandOfAPermutedBand) {
  Random random(10);
  const int n = 200;
  const std::vector<int> order = random.permutation(n);
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i + 1 < n; ++i) {
    const int j = order[static_cast<std::size_t>(i)];
    const int k = order[static_cast<std::size_t>(i) + 1];
    a(j, k) = a(k, j) = 1;
  }
  const BandOrdering ordering = reverse_cuthill_mckee(sparse(a).pattern);
  EXPECT_EQ(ordering.lower, 1);
  EXPECT_EQ(ordering.upper, 1);
  std::vector<int> seen = ordering.position;
  std::ranges::sort(seen);
  for (int i = 0; i < n; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
}

TEST(DefiniteBand, SolvesDefiniteMatricesInAnyUnits) {
  Random random(3);
  constexpr int n = 40;
  Eigen::MatrixXd a = poisson(n);
  for (int i = 0; i + 4 < n; ++i) a(i, i + 4) = a(i + 4, i) = 0.1;
  for (int i = 0; i < n; ++i) {
    const double unit = std::pow(10, i % 7 - 3);
    a.row(i) *= unit;
    a.col(i) *= unit;
  }
  const Sparse s = sparse(a);
  const auto solver = make_definite_solver(LinearKind::banded, s.pattern);
  ASSERT_EQ(solver->factor(s.values), Status::ok);
  const Eigen::VectorXd exact = random.vector(n);
  Eigen::VectorXd x = a * exact;
  ASSERT_EQ(solver->solve(span_of(x)), Status::ok);
  // In the units in which the diagonal is one: n eps times the condition of Poisson's
  // matrix of n points, n^2/2.
  const Eigen::VectorXd unit = a.diagonal().cwiseSqrt();
  EXPECT_LE(((x - exact).cwiseProduct(unit)).norm(),
            eps * n * n * n / 2 * exact.cwiseProduct(unit).norm());
  EXPECT_GE(solver->condition(), 1);
  EXPECT_LE(solver->condition(), n * n);
}

// [1 c; c 1]: the second pivot is 1 - c^2. What the last digit of c changes of it is the
// error.
TEST(DefiniteBand, ConditionIsTheLargestRatioOfADiagonalEntryToItsPivot) {
  const double c = 1 - 1e-6;
  const Sparse s = sparse(Eigen::Matrix2d{{1, c}, {c, 1}});
  const auto solver = make_definite_solver(LinearKind::banded, s.pattern);
  ASSERT_EQ(solver->factor(s.values), Status::ok);
  const double expected = 1 / (1 - c * c);
  EXPECT_NEAR(solver->condition(), expected, 4 * eps * expected * expected);
}

TEST(DefiniteBand, PivotsWhereAMatrixIsIndefiniteOrUnsymmetric) {
  Random random(4);
  constexpr int n = 30;
  Eigen::MatrixXd indefinite = poisson(n);
  indefinite.diagonal().array() -= 1.7;
  Eigen::MatrixXd unsymmetric = poisson(n);
  unsymmetric(3, 4) += 1e-3;
  Eigen::MatrixXd hardly = poisson(n);
  hardly(3, 4) += 1e-9;
  Eigen::MatrixXd lower = Eigen::MatrixXd::Identity(n, n);  // of its pattern too
  lower.diagonal(-1).setConstant(0.5);
  for (const Eigen::MatrixXd& a : {indefinite, unsymmetric, hardly, lower}) {
    const Sparse s = sparse(a);
    const auto solver = make_definite_solver(LinearKind::banded, s.pattern);
    ASSERT_EQ(solver->factor(s.values), Status::ok);
    expect_solves(*solver, a, random.vector(n));
  }
  const Sparse s = sparse(Eigen::MatrixXd(poisson(n) * 0));
  EXPECT_EQ(make_definite_solver(LinearKind::banded, s.pattern)->factor(s.values),
            Status::retry);
}

TEST(Automatic, FollowsThePattern) {
  const auto name = [](const Eigen::MatrixXd& a) {
    return make_linear_solver(LinearKind::automatic, sparse(a).pattern)->name();
  };
  EXPECT_EQ(name(poisson(16)), "dense");
  EXPECT_EQ(name(poisson(17)), "banded");
  Eigen::MatrixXd arrow = poisson(40);
  arrow.row(0).setOnes();
  arrow.col(0).setOnes();
  EXPECT_EQ(name(arrow), "klu");
}

TEST(Automatic, RefusesARectangle) {
  EXPECT_THROW(make_linear_solver(LinearKind::automatic,
                                  sparse(Eigen::MatrixXd::Ones(3, 4)).pattern),
               std::invalid_argument);
}

}  // namespace tress::test_linear_solver
