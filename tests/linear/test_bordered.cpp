// Saddle-point systems by the responses of a solver, against dense references.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "linear/bordered.h"
#include "tests/linear/kkt_case.h"

namespace tress::test_bordered {

using namespace testing_matrices;

class BorderedOf : public testing::Test {
 protected:
  Status factor(const Problem& p) {
    s_.compute(p.s);
    const Sparse gt = sparse(p.g.transpose());
    if (!bordered_) {
      const VectorXd typical = VectorXd::Ones(p.s.rows());
      bordered_ = std::make_unique<Bordered>(
          [this](InOut b) {
            Eigen::Map<VectorXd> x(b.data(), std::ssize(b));
            x = s_.solve(x).eval();
            return Status::ok;
          },
          gt.pattern, In(typical.data(), std::size_t(typical.size())));
    }
    return bordered_->factor(gt.values, sparse(p.h.transpose(), p.g.transpose()).values);
  }
  Solution solve(const VectorXd& b, const VectorXd& c) {
    Solution r{b, c};
    EXPECT_EQ(bordered_->solve(span_of(r.x), span_of(r.y)), Status::ok);
    return r;
  }
  /// Rounding of S and of W, amplified by their conditions: some 1e2 each here.
  void expect_dense(const Problem& p, const VectorXd& b, const VectorXd& c) {
    VectorXd right(b.size() + c.size());
    right << b, c;
    const VectorXd expected = dense_solve(saddle(p), right);
    const Solution found = solve(b, c);
    EXPECT_LE((found.x - expected.head(b.size())).norm(), 1e-12 * expected.norm());
    EXPECT_LE((found.y - expected.tail(c.size())).norm(), 1e-12 * expected.norm());
  }

  Eigen::PartialPivLU<MatrixXd> s_;
  std::unique_ptr<Bordered> bordered_;
};

TEST_F(BorderedOf, AgreesWithDense) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    Problem p = random_problem(random, 30, 6);
    bordered_.reset();
    ASSERT_EQ(factor(p), Status::ok);
    EXPECT_EQ(bordered_->report().rank_deficiency, 0);
    expect_dense(p, random.vector(30), random.vector(6));
    p.h = p.g.cwiseProduct(random.matrix(6, 30));
    p.h.leftCols(6).diagonal().array() += 2;
    ASSERT_EQ(factor(p), Status::ok);
    expect_dense(p, random.vector(30), random.vector(6));
  }
}

/// Rows of any size are scaled: 1e-9 is the row along a strand that is nearly straight.
TEST_F(BorderedOf, ScalesItsRows) {
  Random random(8);
  Problem p = random_problem(random, 20, 4);
  p.g.row(2) *= 1e-9;
  p.h = p.g;
  ASSERT_EQ(factor(p), Status::ok);
  EXPECT_EQ(bordered_->report().rank_deficiency, 0);
  EXPECT_LE(bordered_->report().condition, 1e3);
  const VectorXd x = random.vector(20), y = random.vector(4);
  const Solution found = solve(p.s * x - p.g.transpose() * y, p.h * x);
  EXPECT_LE((found.x - x).norm(), 1e-12 * x.norm());
  // y[2] has lost the nine digits by which its row is smaller.
  EXPECT_LE((found.y - y).cwiseProduct(p.g.rowwise().norm()).norm(), 1e-12 * y.norm());
}

TEST_F(BorderedOf, SolvesRedundantConstraintsInLeastSquares) {
  Random random(12);
  Problem p = random_problem(random, 30, 5);
  MatrixXd g(7, 30);
  g << p.g, p.g.row(3), -2.5 * p.g.row(1);
  p.g = p.h = g;
  ASSERT_EQ(factor(p), Status::ok);
  EXPECT_EQ(bordered_->report().rank_deficiency, 2);
  const VectorXd b = random.vector(30);
  for (const VectorXd& c : {VectorXd(p.g * random.vector(30)), random.vector(7)}) {
    const Solution expected = pseudo_inverse(p, b, c), found = solve(b, c);
    EXPECT_LE((found.x - expected.x).norm(), redundant_accuracy * expected.x.norm());
    EXPECT_LE((found.y - expected.y).norm(), redundant_accuracy * expected.y.norm());
  }
  // Independent again.
  p.g.row(5) = random.vector(30).transpose();
  p.g.row(6) = random.vector(30).transpose();
  p.h = p.g;
  bordered_.reset();
  ASSERT_EQ(factor(p), Status::ok);
  expect_dense(p, b, random.vector(7));
}

TEST_F(BorderedOf, AsksForARetryOnValuesThatAreNotFinite) {
  Random random(3);
  Problem p = random_problem(random, 10, 2);
  ASSERT_EQ(factor(p), Status::ok);
  p.h(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(factor(p), Status::retry);
}

}  // namespace tress::test_bordered
