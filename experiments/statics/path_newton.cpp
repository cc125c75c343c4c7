#include "experiments/statics/path_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "experiments/numerics/dense_algebra.h"

namespace tress::experiments::statics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Of typical sizes. Where stretch is stiff, rounding stops corrections from shrinking:
// below `rounding`, after `in_vain` of them, they are accepted.
constexpr double attainable = 1e-11, rounding = 1e-6, longest_correction = 2;
constexpr int in_vain = 3, most_iterations = 25;

}  // namespace

PathNewton::PathNewton(StaticStrand& strand)
    : neutral(strand.coordinates(), 0),
      strand_(strand),
      size_(Eigen::Map<const VectorXd>(strand.typical().data(), strand.coordinates())),
      range_(strand.varied().range()) {}

double PathNewton::product(const Direction& a, const Direction& b) const {
  const VectorXd x = a.q.cwiseQuotient(size_), y = b.q.cwiseQuotient(size_);
  return x.dot(y) / static_cast<double>(x.size()) + a.value * b.value / (range_ * range_);
}

Direction PathNewton::row(const Direction& of) const {
  const VectorXd weight = size_.cwiseAbs2() * static_cast<double>(size_.size());
  return {of.q.cwiseQuotient(weight), of.value / (range_ * range_)};
}
Direction PathNewton::fixed() const { return {VectorXd::Zero(size_.size()), 1}; }

/// [dR/dq -G^T dR/dp N; G 0 dg/dp 0; row 0 value 0; N^T 0 0 0] with N the neutral modes.
MatrixXd PathNewton::bordered(const Balance& at, const VectorXd& by_parameter,
                              const Direction& row) {
  const Index n = at.q.size(), m = at.lambda.size(), k = neutral.cols();
  const StaticStrand::Slopes slopes = strand_.slopes(at);
  MatrixXd all = MatrixXd::Zero(n + m + 1 + k, n + m + 1 + k);
  all.topLeftCorner(n, n) = slopes.stiffness;
  all.block(0, n, n, m) = -slopes.gradient;
  all.block(n, 0, m, n) = slopes.gradient.transpose();
  all.col(n + m).head(n + m) = by_parameter;
  all.row(n + m).head(n) = row.q.transpose();
  all(n + m, n + m) = row.value;
  const MatrixXd held = size_.cwiseAbs2().cwiseInverse().asDiagonal() * neutral;
  all.topRightCorner(n, k) = held;
  all.bottomLeftCorner(k, n) = held.transpose();
  return all;
}

Newton PathNewton::correct(Balance& at, const Direction& row, const Balance& origin) {
  Newton newton;
  const Index n = at.q.size(), m = at.lambda.size();
  VectorXd by_parameter;
  double best = std::numeric_limits<double>::infinity();
  for (int worse = 0; newton.iterations < most_iterations;) {
    if (newton.iterations % in_vain == 0) by_parameter = strand_.by_parameter(at);
    MatrixXd all = bordered(at, by_parameter, row);
    VectorXd right = VectorXd::Zero(all.rows());
    right.head(n + m) = strand_.residual(at);
    right[n + m] = row.q.dot(at.q - origin.q) + row.value * (at.value - origin.value);
    const MixedSolution found =
        mixed_solution(std::move(all), std::move(right), strand_.typical());
    if (!found.scaled.allFinite()) return newton;
    const VectorXd change = found.unknowns();
    ++newton.iterations;
    newton.last = std::max(found.scaled.head(n).cwiseAbs().maxCoeff(),
                           std::abs(change[n + m]) / range_);
    if (newton.last > longest_correction) return newton;
    at.q -= change.head(n);
    at.lambda -= change.segment(n, m);
    at.value -= change[n + m];
    worse = newton.last < best / 2 ? 0 : worse + 1;
    best = std::min(best, newton.last);
    newton.converged =
        newton.last <= attainable || (newton.last <= rounding && worse >= in_vain);
    if (newton.converged) return newton;
  }
  return newton;
}

Direction PathNewton::tangent(const Balance& at, const Direction& before) {
  const Index n = at.q.size(), m = at.lambda.size();
  MatrixXd all = bordered(at, strand_.by_parameter(at), row(before));
  VectorXd right = VectorXd::Zero(all.rows());
  right[n + m] = 1;
  const MixedSolution found =
      mixed_solution(std::move(all), std::move(right), strand_.typical());
  if (!found.scaled.allFinite()) throw std::runtime_error("the path has no tangent");
  const VectorXd change = found.unknowns();
  Direction d{change.head(n), change[n + m]};
  const double length = std::sqrt(product(d, d));
  return {d.q / length, d.value / length};
}

}  // namespace tress::experiments::statics
