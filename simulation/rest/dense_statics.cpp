#include "simulation/rest/dense_statics.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/sparse_form.h"
#include "linear/dense_algebra.h"
#include "linear/sparse_pattern.h"

namespace tress::simulation {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

Out span(VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

void check(Status s) {
  if (s != Status::ok) throw std::runtime_error("its forces at rest are not finite");
}

MatrixXd dense(const Pattern& pattern, In values) {
  MatrixXd all(pattern.rows, pattern.cols);
  to_dense(pattern, values, {all.data(), static_cast<std::size_t>(all.size())});
  return all;
}

/// `ridge` times the largest norm of a column.
double ridge_of(const MatrixXd& m, double ridge) {
  return m.cols() == 0 ? 0 : ridge * m.colwise().norm().maxCoeff();
}

}  // namespace

DenseStatics::DenseStatics(System& system, In q)
    : system_(system), q_(Eigen::Map<const VectorXd>(q.data(), std::ssize(q))) {
  zero_ = VectorXd::Zero(q_.size());
  scale_ = zero_;
  VectorXd rates = zero_;
  system_.scale(span(scale_), span(rates));
  take_constraints();
}

VectorXd DenseStatics::full_residual() {
  VectorXd r(q_.size());
  check(system_.residual(0, span(q_), span(zero_), span(zero_), span(r)));
  return r;
}

VectorXd DenseStatics::residual() {
  const VectorXd r = full_residual();
  if (basis_.size() == 0) return r;
  return basis_.transpose() * r;
}

MatrixXd DenseStatics::displacement(const MatrixXd& y) const {
  if (basis_.size() == 0) return y;
  return basis_ * y;
}

void DenseStatics::take_constraints() {
  ConstraintForm* const constraints = system_.constraint_form();
  if (constraints == nullptr) return;
  const Pattern& pattern = constraints->pattern();
  std::vector<double> values(static_cast<std::size_t>(pattern.nonzeros()));
  check(constraints->gradient(0, span(q_), values));
  const MatrixXd gradient = dense(pattern, values);
  basis_ = complement(gradient);
  lambda_ = least_squares_solution(gradient, full_residual());
}

const MatrixXd& DenseStatics::stiffness() {
  if (stiffness_.size() > 0) return stiffness_;
  if (SparseForm* const form = system_.sparse_form()) {
    std::vector<double> values(static_cast<std::size_t>(form->pattern().nonzeros()));
    check(form->values(0, span(q_), span(zero_), span(zero_), {0, 0, 1}, values));
    if (lambda_.size() > 0) {
      check(system_.constraint_form()->add_curvature(0, span(q_), span(lambda_), -1,
                                                     values));
    }
    stiffness_ = dense(form->pattern(), values);
  } else {
    // Not by differences: a step beyond the depths of contacts finds other ones.
    check(system_.linearize(0, span(q_), span(zero_), span(zero_), {0, 0, 1}));
    MatrixXd compliance(q_.size(), q_.size());
    VectorXd force = zero_, way = zero_;
    for (Index k = 0; k < q_.size(); ++k) {
      force[k] = 1;
      check(system_.solve(span(force), span(way)));
      force[k] = 0;
      compliance.col(k) = way;
    }
    stiffness_ = solution(compliance, MatrixXd::Identity(q_.size(), q_.size()));
  }
  if (basis_.size() > 0) stiffness_ = basis_.transpose() * stiffness_ * basis_;
  return stiffness_ = (0.5 * (stiffness_ + stiffness_.transpose())).eval();
}

VectorXd DenseStatics::pull(In from, In to) {
  VectorXd way(q_.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    way[static_cast<Index>(i)] = to[i] - from[i];
  }
  if (basis_.size() > 0) way = (basis_.transpose() * way).eval();
  return stiffness() * way;
}

MatrixXd DenseStatics::by_natural(NaturalStrains& strains) {
  std::vector<double> natural = strains.natural();
  const VectorXd before = residual();
  MatrixXd all(before.size(), std::ssize(natural));
  for (std::size_t k = 0; k < natural.size(); ++k) {
    const double kept = natural[k];
    natural[k] += 1;  // the residual is affine in it
    strains.set_natural(natural);
    all.col(static_cast<Index>(k)) = residual() - before;
    natural[k] = kept;
  }
  strains.set_natural(natural);
  return all;
}

double least_definite(const MatrixXd& a, const MatrixXd& b) {
  const auto definite = [&](double s) { return is_definite(a + (s - 1) * b); };
  constexpr double least = 1e-4, most = 1e6, close = 1e-7;
  if (definite(least)) return 0;
  double low = least, high = 1;
  while (!definite(high)) {
    low = high;
    high *= 4;
    if (high > most) return std::numeric_limits<double>::infinity();
  }
  while (high - low > close * high) {
    const double middle = (low + high) / 2;
    (definite(middle) ? high : low) = middle;
  }
  return high;
}

MatrixXd least_squares(const MatrixXd& m, const MatrixXd& b, double ridge) {
  MatrixXd with_ridge = MatrixXd::Zero(m.rows() + m.cols(), m.cols());
  with_ridge.topRows(m.rows()) = m;
  with_ridge.bottomRows(m.cols()).diagonal().setConstant(ridge_of(m, ridge));
  MatrixXd right = MatrixXd::Zero(with_ridge.rows(), b.cols());
  right.topRows(b.rows()) = b;
  return least_squares_solution(with_ridge, right);
}

VectorXd nonnegative(const MatrixXd& a, const VectorXd& b, double ridge) {
  const Index n = a.cols();
  MatrixXd gram = a.transpose() * a;
  gram.diagonal().array() += std::pow(ridge_of(a, ridge), 2);
  const VectorXd right = a.transpose() * b;
  const double small = 1e-12 * right.cwiseAbs().maxCoeff();
  VectorXd x = VectorXd::Zero(n);
  std::vector<Index> active;
  const auto solve_active = [&] {
    const auto m = std::ssize(active);
    MatrixXd g(m, m);
    VectorXd y(m);
    for (Index i = 0; i < m; ++i) {
      y[i] = right[active[static_cast<std::size_t>(i)]];
      for (Index j = 0; j < m; ++j) {
        g(i, j) = gram(active[static_cast<std::size_t>(i)],
                       active[static_cast<std::size_t>(j)]);
      }
    }
    return VectorXd(solution(g, y));
  };
  for (Index round = 0; round < 3 * n; ++round) {
    const VectorXd slope = right - gram * x;
    Index best = -1;
    for (Index k = 0; k < n; ++k) {
      if (std::ranges::find(active, k) != active.end() || slope[k] <= small) continue;
      if (best < 0 || slope[k] > slope[best]) best = k;
    }
    if (best < 0) break;
    active.push_back(best);
    for (;;) {
      const VectorXd y = solve_active();
      double part = 1;  // of the way to y, up to where the first becomes 0
      Index first = -1;
      for (Index i = 0; i < y.size(); ++i) {
        const Index k = active[static_cast<std::size_t>(i)];
        if (y[i] > 0 || x[k] / (x[k] - y[i]) >= part) continue;
        part = x[k] / (x[k] - y[i]);
        first = k;
      }
      std::vector<Index> still;
      for (Index i = 0; i < y.size(); ++i) {
        const Index k = active[static_cast<std::size_t>(i)];
        x[k] += part * (y[i] - x[k]);
        if (k == first || (part < 1 && x[k] <= 0)) {
          x[k] = 0;
        } else {
          still.push_back(k);
        }
      }
      if (first < 0) break;
      active = std::move(still);
      if (active.empty()) break;
    }
  }
  return x;
}

}  // namespace tress::simulation
