#include <gtest/gtest.h>

#include <cmath>

#include "linear/least_norm.h"
#include "tests/linear/kkt_case.h"

namespace tress::test_redundant {

using namespace testing_matrices;

class KktRedundant : public KktOf {};
INSTANTIATE_TEST_SUITE_P(All, KktRedundant,
                         testing::Values(LinearKind::automatic, LinearKind::klu,
                                         LinearKind::banded, LinearKind::dense),
                         kind_name);

TEST_P(KktRedundant, SolvesDuplicatedConstraintsInLeastSquares) {
  Random random(12);
  Problem p = chain(random, 12, 1e-8);
  MatrixXd g(15, 36);
  g << p.g, p.g.row(3), -2.5 * p.g.row(7), p.g.row(3);
  p.g = p.h = g;
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  EXPECT_EQ(kkt_->report().rank_deficiency, 3);
  const VectorXd b = 1e-8 * random.vector(36);
  expect_least_squares(p, b, p.g * random.vector(36));  // consistent
  expect_least_squares(p, b, random.vector(15));        // inconsistent
}

// H has the rows of G in other units, so that null(H^T) is not null(G^T).
TEST_P(KktRedundant, ConstraintRowsLoseTheirOwnNullSpace) {
  Random random(16);
  Problem p = chain(random, 12, 1e-8);
  MatrixXd g(14, 36);
  g << p.g, p.g.row(3), -2.5 * p.g.row(7);
  p.g = g;
  p.h = Eigen::VectorXd::LinSpaced(14, 0.5, 4).asDiagonal() * g;
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  EXPECT_EQ(kkt_->report().rank_deficiency, 2);
  const VectorXd b = 1e-8 * random.vector(36), x = random.vector(36);
  const VectorXd c = p.h * x;
  const Solution found = solve(b, c);
  EXPECT_LE((p.h * found.x - c).norm(), redundant_accuracy * c.norm());
}

/// Distances between nodes, one gradient a row.
MatrixXd bars(const MatrixXd& nodes, const std::vector<std::pair<int, int>>& ends) {
  MatrixXd g = MatrixXd::Zero(static_cast<Eigen::Index>(ends.size()), 2 * nodes.cols());
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const auto [i, j] = ends[k];
    const Eigen::Vector2d d = (nodes.col(j) - nodes.col(i)).normalized();
    g.block(static_cast<Eigen::Index>(k), 2 * i, 1, 2) = -d.transpose();
    g.block(static_cast<Eigen::Index>(k), 2 * j, 1, 2) = d.transpose();
  }
  return g;
}

// Four nodes in a plane have 5 shapes: six bars are one too many in every configuration.
TEST_P(KktRedundant, SolvesAnOverConstrainedSquareTruss) {
  Random random(13);
  const std::vector<std::pair<int, int>> ends = {{0, 1}, {1, 2}, {2, 3},
                                                 {3, 0}, {0, 2}, {1, 3}};
  MatrixXd nodes(2, 4);
  nodes << 0, 1, 1, 0, 0, 0, 1, 1;
  const MatrixXd shape = bars(random.matrix(2, 4), ends);
  Problem p;
  p.s = Eigen::Vector<double, 8>(1, 1, 2, 2, 3, 3, 4, 4).asDiagonal();
  p.g = shape;
  p.h = p.g;
  make(p, shape.transpose());
  for (int trial = 0; trial < 3; ++trial) {  // the self-stress moves with the nodes
    p.g = p.h = bars(nodes, ends);
    ASSERT_EQ(factor(p), Status::ok);
    EXPECT_EQ(kkt_->report().rank_deficiency, 1);
    const VectorXd b = random.vector(8);
    expect_least_squares(p, b, p.g * random.vector(8));
    expect_least_squares(p, b, random.vector(6));
    nodes += 0.1 * random.matrix(2, 4);
  }
}

TEST_P(KktRedundant, SolvesMoreConstraintsThanCoordinates) {
  Random random(14);
  Problem p;
  p.s = MatrixXd::Identity(6, 6) + 0.1 * random.matrix(6, 6);
  p.g = p.h = random.matrix(9, 6);
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  EXPECT_EQ(kkt_->report().rank_deficiency, 3);
  expect_least_squares(p, random.vector(6), random.vector(9));
}

TEST_P(KktRedundant, SeesRedundancyAppearGrowAndVanish) {
  Random random(15);
  const Problem regular = random_problem(random, 24, 8);
  Problem one = regular;
  one.g.row(5) = 2 * one.g.row(2);
  one.h = one.g;
  Problem two = one;
  two.g.row(6).setZero();
  two.h = two.g;
  make(regular, MatrixXd::Ones(24, 8));
  const VectorXd b = random.vector(24), c = random.vector(8);
  const Problem* const with[] = {&regular, &one, &two};
  for (int redundant : {0, 1, 2, 1, 0, 2, 0}) {
    const Problem& p = *with[redundant];
    ASSERT_EQ(factor(p), Status::ok);
    EXPECT_EQ(kkt_->report().rank_deficiency, redundant);
    expect_least_squares(p, b, c);
  }
}

TEST_P(KktRedundant, AsksForARetryWhenRedundantAndSingularOtherwise) {
  Random random(16);
  Problem p = random_problem(random, 20, 5);
  p.g.row(1) = p.g.row(0);
  p.g.col(9).setZero();
  p.g.col(8).setZero();
  p.h = p.g;
  p.s.row(9) = p.s.row(8);
  make(p);
  EXPECT_EQ(factor(p), Status::retry);
}

// A = s t^T has rank 1: A x = 2 s for x = 2 t/(t.t) + any vector perpendicular to t.
TEST(LeastNorm, IsTheShortestOfTheSolutions) {
  const std::vector<double> s{1e-6, -3, 2e4}, t{1, 2, -2};
  std::vector<double> columns, x;
  for (const double by_column : t) {
    for (const double by_row : s) columns.push_back(by_row * by_column);
  }
  LeastNorm solver;
  ASSERT_TRUE(solver.factor(columns, s.size()));
  for (const double entry : s) x.push_back(2 * entry);
  solver.solve(x);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], 2 * t[i] / 9, 1e-15);
  columns[4] = std::nan("");
  EXPECT_FALSE(solver.factor(columns, s.size()));
}

}  // namespace tress::test_redundant
