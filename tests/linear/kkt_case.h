#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "linear/kkt.h"
#include "tests/linear/matrices.h"
#include "tests/support/dense.h"

namespace tress::testing_matrices {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_support::dense_solve;
using testing_support::least_squares;

inline constexpr double eps = std::numeric_limits<double>::epsilon();
/// What the header promises of x against a dense reference with redundant constraints.
inline constexpr double redundant_accuracy = 1e-10;

struct Problem {
  MatrixXd s, g, h;
};

struct Solution {
  VectorXd x, y;
};

inline MatrixXd saddle(const Problem& p) {
  const Eigen::Index n = p.s.rows(), m = p.g.rows();
  MatrixXd k = MatrixXd::Zero(n + m, n + m);
  k << p.s, -p.g.transpose(), p.h, MatrixXd::Zero(m, m);
  return k;
}

/// y = pinv(A) (c - H S^-1 b), A = H S^-1 G^T: least squares of least norm.
inline Solution pseudo_inverse(const Problem& p, const VectorXd& b, const VectorXd& c) {
  const MatrixXd a = p.h * dense_solve(p.s, p.g.transpose());
  Solution r;
  r.y = least_squares(a, c - p.h * dense_solve(p.s, b), 1e-11);
  r.x = dense_solve(p.s, b + p.g.transpose() * r.y);
  return r;
}

inline Problem random_problem(Random& random, int n, int m) {
  Problem p;
  p.s = random.thinned(n, n, 0.1);
  p.s.diagonal().array() += 4;
  p.g = random.thinned(m, n, 0.3);
  p.g.leftCols(m).diagonal().array() += 1;
  p.h = p.g;
  return p;
}

/// Links between nodes of a random walk whose first node hangs on the ground.
inline Problem chain(Random& random, int links, double mass) {
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

/// One saddle-point problem under one kind of solver, against dense references.
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
    const VectorXd expected = dense_solve(saddle(p), right);
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

}  // namespace tress::testing_matrices
