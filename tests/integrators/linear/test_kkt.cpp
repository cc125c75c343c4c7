#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "integrators/linear/kkt.h"
#include "tests/integrators/linear/matrices.h"

namespace tress {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_matrices::kind_name;
using testing_matrices::Random;
using testing_matrices::span_of;
using testing_matrices::Sparse;
using testing_matrices::sparse;

constexpr double eps = std::numeric_limits<double>::epsilon();
/// What the header promises of x against a dense reference with redundant constraints.
constexpr double redundant_accuracy = 1e-10;

struct Problem {
  MatrixXd s, g, h;
};

struct Solution {
  VectorXd x, y;
};

MatrixXd saddle(const Problem& p) {
  const Eigen::Index n = p.s.rows(), m = p.g.rows();
  MatrixXd k = MatrixXd::Zero(n + m, n + m);
  k << p.s, -p.g.transpose(), p.h, MatrixXd::Zero(m, m);
  return k;
}

/// y = pinv(A) (c - H S^-1 b), A = H S^-1 G^T: least squares of least norm.
Solution pseudo_inverse(const Problem& p, const VectorXd& b, const VectorXd& c) {
  const Eigen::FullPivLU<MatrixXd> s(p.s);
  const MatrixXd a = p.h * s.solve(p.g.transpose());
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> inverse;
  inverse.setThreshold(1e-11);
  inverse.compute(a);
  Solution r;
  r.y = inverse.solve(c - p.h * s.solve(b));
  r.x = s.solve(b + p.g.transpose() * r.y);
  return r;
}

class KktOf : public testing::TestWithParam<LinearKind> {
 protected:
  void make(const Problem& p) { make(p, p.g.transpose()); }
  /// `shape`: where the gradients may have entries.
  void make(const Problem& p, const MatrixXd& shape) {
    shape_ = shape;
    kkt_ = std::make_unique<Kkt>(GetParam(), sparse(p.s).pattern,
                                 sparse(shape, shape).pattern);
  }
  Status factor(const Problem& p) {
    return kkt_->factor(sparse(p.s).values, sparse(p.g.transpose(), shape_).values,
                        sparse(p.h.transpose(), shape_).values);
  }
  Solution solve(const VectorXd& b, const VectorXd& c) {
    Solution r{b, c};
    EXPECT_EQ(kkt_->solve(span_of(r.x), span_of(r.y)), Status::ok);
    return r;
  }
  void expect_least_squares(const Problem& p, const VectorXd& b, const VectorXd& c) {
    const Solution expected = pseudo_inverse(p, b, c);
    const Solution found = solve(b, c);
    EXPECT_LE((found.x - expected.x).norm(), redundant_accuracy * expected.x.norm());
    EXPECT_LE((found.y - expected.y).norm(), redundant_accuracy * expected.y.norm());
  }
  /// Two unit roundoffs of every entry, amplified by the condition the report estimates
  /// from below (a factor n for the estimate, n for the sums).
  void expect_dense(const Problem& p, const VectorXd& b, const VectorXd& c) {
    const Eigen::Index n = b.size();
    VectorXd right(n + c.size());
    right << b, c;
    const VectorXd expected = saddle(p).fullPivLu().solve(right);
    const Solution found = solve(b, c);
    const double size = static_cast<double>(right.size());
    const double bound = eps * size * size * kkt_->report().condition;
    EXPECT_LE((found.x - expected.head(n)).norm(), bound * expected.head(n).norm());
    EXPECT_LE((found.y - expected.tail(c.size())).norm(),
              bound * expected.tail(c.size()).norm());
  }

  MatrixXd shape_;
  std::unique_ptr<Kkt> kkt_;
};

INSTANTIATE_TEST_SUITE_P(All, KktOf,
                         testing::Values(LinearKind::automatic, LinearKind::klu,
                                         LinearKind::banded, LinearKind::dense),
                         kind_name);

Problem random_problem(Random& random, int n, int m) {
  Problem p;
  p.s = random.thinned(n, n, 0.1);
  p.s.diagonal().array() += 4;
  p.g = random.thinned(m, n, 0.3);
  p.g.leftCols(m).diagonal().array() += 1;
  p.h = p.g;
  return p;
}

TEST_P(KktOf, AgreesWithDense) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const Problem p = random_problem(random, 30, 12);
    make(p);
    ASSERT_EQ(factor(p), Status::ok);
    EXPECT_EQ(kkt_->report().rank_deficiency, 0);
    expect_dense(p, random.vector(30), random.vector(12));
  }
}

TEST_P(KktOf, TakesAnotherMatrixForTheConstraintRows) {
  Random random(6);
  Problem p = random_problem(random, 30, 12);
  p.h = p.g.cwiseProduct(random.matrix(12, 30));
  p.h.leftCols(12).diagonal().array() += 2;
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  expect_dense(p, random.vector(30), random.vector(12));
}

TEST_P(KktOf, WorksWithoutConstraints) {
  Random random(7);
  Problem p = random_problem(random, 20, 0);
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  expect_dense(p, random.vector(20), VectorXd(0));
  p.s.col(3) = p.s.col(4);  // keeps the pattern of neither column
  make(p);
  EXPECT_EQ(factor(p), Status::retry);
}

/// Links between nodes of a random walk whose first node hangs on the ground.
Problem chain(Random& random, int links, double mass) {
  Problem p;
  p.s = mass * MatrixXd::Identity(3 * links, 3 * links);
  p.g = MatrixXd::Zero(links, 3 * links);
  for (int k = 0; k < links; ++k) {
    const VectorXd d = random.vector(3).normalized();
    p.g.block(k, 3 * k, 1, 3) = d.transpose();
    if (k > 0) p.g.block(k, 3 * k - 3, 1, 3) = -d.transpose();
  }
  p.h = p.g;
  return p;
}

// The same equations in other units: x is exactly as well determined.
TEST_P(KktOf, DoesNotMistakeSmallMassesForMissingRank) {
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
      const Solution found =
          solve(p.s * expected - p.g.transpose() * y, p.h * expected);
      const double bound = eps * 80 * 80 * kkt_->report().condition;
      EXPECT_LE((found.x - expected).norm(), bound * expected.norm());
      EXPECT_LE((found.y - y).norm(), bound * y.norm());
    }
  }
}

TEST_P(KktOf, AcceptsMasslessCoordinates) {
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

TEST_P(KktOf, AsksForARetryWhenSingularWithIndependentConstraints) {
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

TEST_P(KktOf, AsksForARetryOnValuesThatAreNotFinite) {
  Random random(11);
  const Problem p = random_problem(random, 20, 5);
  make(p);
  Problem bad = p;
  bad.s(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(factor(bad), Status::retry);
  ASSERT_EQ(factor(p), Status::ok);
  expect_dense(p, random.vector(20), random.vector(5));
}

TEST_P(KktOf, SolvesDuplicatedConstraintsInLeastSquares) {
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
TEST_P(KktOf, SolvesAnOverConstrainedSquareTruss) {
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

TEST_P(KktOf, SolvesMoreConstraintsThanCoordinates) {
  Random random(14);
  Problem p;
  p.s = MatrixXd::Identity(6, 6) + 0.1 * random.matrix(6, 6);
  p.g = p.h = random.matrix(9, 6);
  make(p);
  ASSERT_EQ(factor(p), Status::ok);
  EXPECT_EQ(kkt_->report().rank_deficiency, 3);
  expect_least_squares(p, random.vector(6), random.vector(9));
}

TEST_P(KktOf, SeesRedundancyAppearGrowAndVanish) {
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

TEST_P(KktOf, AsksForARetryWhenRedundantAndSingularOtherwise) {
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

}  // namespace
}  // namespace tress
