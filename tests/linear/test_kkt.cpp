#include <gtest/gtest.h>

#include <cmath>

#include "tests/linear/kkt_case.h"

namespace tress::test_kkt {

using namespace testing_matrices;

class KktSolver : public KktOf {};
INSTANTIATE_TEST_SUITE_P(All, KktSolver,
                         testing::Values(LinearKind::automatic, LinearKind::klu,
                                         LinearKind::banded, LinearKind::dense),
                         kind_name);

TEST_P(KktSolver, AgreesWithDense) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const Problem p = random_problem(random, 30, 12);
    make(p);
    ASSERT_EQ(factor(p), Status::ok);
    EXPECT_EQ(kkt_->report().rank_deficiency, 0);
    expect_dense(p, random.vector(30), random.vector(12));
  }
}

TEST_P(KktSolver, TakesAnotherMatrixForTheConstraintRows) {
  Random random(6);
  Problem p = random_problem(random, 30, 12);
  p.h = p.g.cwiseProduct(random.matrix(12, 30));
  p.h.leftCols(12).diagonal().array() += 2;
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  expect_dense(p, random.vector(30), random.vector(12));
}

TEST_P(KktSolver, WorksWithoutConstraints) {
  Random random(7);
  Problem p = random_problem(random, 20, 0);
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  expect_dense(p, random.vector(20), VectorXd(0));
  p.s.col(3) = p.s.col(4);  // keeps the pattern of neither column
  make(p);
  EXPECT_EQ(factor(p), Status::retry);
}

// The same equations in other units: x is exactly as well determined.
TEST_P(KktSolver, DoesNotMistakeSmallMassesForMissingRank) {
  Random random(8);
  for (double mass : {1e-8, 1.0, 1e12}) {
    for (double unit : {1e-12, 1.0, 1e12}) {  // of the constraints
      Problem p = chain(random, 20, mass);
      p.s.diagonal().array() *= (VectorXd::Random(60).array() * 3).exp();
      p.g *= unit;
      p.h = p.g;
      make(p);
      ASSERT_EQ(factor(p), Status::ok);
      EXPECT_EQ(kkt_->report().rank_deficiency, 0);
      EXPECT_LE(kkt_->report().condition, 1e5);
      const VectorXd expected = random.vector(60);
      const VectorXd y = mass / unit * random.vector(20);
      const Solution found = solve(p.s * expected - p.g.transpose() * y, p.h * expected);
      const double bound = eps * 80 * 80 * kkt_->report().condition;
      EXPECT_LE((found.x - expected).norm(), bound * expected.norm());
      EXPECT_LE((found.y - y).norm(), bound * y.norm());
    }
  }
}

TEST_P(KktSolver, AcceptsMasslessCoordinates) {
  Random random(9);
  Problem p = chain(random, 10, 1e-8);
  // One held by constraints alone, one coupled to its neighbour in S alone.
  p.g.col(2).setZero();
  p.g(0, 2) = 0.7;
  p.s.row(2).setZero();
  p.s.col(2).setZero();
  p.h = p.g;
  p.s(14, 14) = 0;
  p.s(14, 13) = 3e-9;
  p.s(13, 14) = -3e-9;
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  EXPECT_EQ(kkt_->report().rank_deficiency, 0);
  const VectorXd expected = random.vector(30), y = 1e-8 * random.vector(10);
  const Solution found = solve(p.s * expected - p.g.transpose() * y, p.h * expected);
  const double bound = eps * 40 * 40 * kkt_->report().condition;
  EXPECT_LE(kkt_->report().condition, 1e5);
  EXPECT_LE((found.x - expected).norm(), bound * expected.norm());
  EXPECT_LE((found.y - y).norm(), bound * y.norm());
}

TEST_P(KktSolver, AsksForARetryWhenSingularWithIndependentConstraints) {
  Random random(10);
  Problem p = random_problem(random, 20, 5);
  p.s.row(9) = p.s.row(8);
  p.g.col(9).setZero();
  p.g.col(8).setZero();
  p.h = p.g;
  make(p, p.g.transpose());
  EXPECT_EQ(factor(p), Status::retry);
  EXPECT_EQ(kkt_->report().rank_deficiency, 0);
}

TEST_P(KktSolver, AsksForARetryOnValuesThatAreNotFinite) {
  Random random(11);
  const Problem p = random_problem(random, 20, 5);
  make(p);
  Problem bad = p;
  bad.s(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(factor(bad), Status::retry);
  ASSERT_EQ(factor(p), Status::ok);
  expect_dense(p, random.vector(20), random.vector(5));
}

TEST(Kkt, BandedAndKluAgreeOnALongChain) {
  const int links = 10000;
  Random random(17);
  const Pattern s = identity_pattern(3 * links);
  const std::vector<double> mass(static_cast<std::size_t>(3 * links), 1e-8);
  Pattern gt;
  gt.rows = 3 * links;
  gt.cols = links;
  gt.start.push_back(0);
  std::vector<double> g;
  for (int k = 0; k < links; ++k) {
    const VectorXd d = random.vector(3).normalized();
    for (int node = std::max(0, k - 1); node <= k; ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        gt.row.push_back(3 * node + axis);
        g.push_back(node < k ? -d(axis) : d(axis));
      }
    }
    gt.start.push_back(static_cast<int>(gt.row.size()));
  }
  VectorXd x[2], y[2];
  double condition = 0;
  for (int i = 0; i < 2; ++i) {
    Kkt kkt(i == 0 ? LinearKind::klu : LinearKind::banded, s, gt);
    ASSERT_EQ(kkt.factor(mass, g, g), Status::ok);
    ASSERT_EQ(kkt.factor(mass, g, g), Status::ok);  // with kept pivots
    x[i] = VectorXd::Constant(3 * links, -9.81e-8);
    y[i] = VectorXd::LinSpaced(links, -1, 1);
    ASSERT_EQ(kkt.solve(span_of(x[i]), span_of(y[i])), Status::ok);
    condition = kkt.report().condition;
  }
  // Sums of band length, amplified by the condition: sqrt(4 links) for its underestimate.
  const double bound = eps * 16 * std::sqrt(4.0 * links) * condition;
  EXPECT_LE((x[0] - x[1]).norm(), bound * x[0].norm());
  EXPECT_LE((y[0] - y[1]).norm(), bound * y[0].norm());
}

}  // namespace tress::test_kkt
