#include "experiments/statics/stability.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <vector>

#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/small_motions.h"

namespace tress::experiments::statics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rounding of an eigenvalue over the largest one. Double real eigenvalues, as of bending
/// in both planes of a round section, come out as a pair. Its distance over its size is
/// the root of this rounding over that size.
constexpr double eigenvalue_rounding = 64 * std::numeric_limits<double>::epsilon();

/// A mode of the path is no longer neutral where its eigenvalue exceeds the limit of
/// neutral ones by this factor. The residual that Newton's method leaves moves the
/// eigenvalue of a spin.
constexpr double lift = 10;

/// Neutral modes have eigenvalues up to this one.
double limit_of(const VectorXd& values) {
  const double rounding = 64 * std::numeric_limits<double>::epsilon() *
                          (values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0);
  return std::max(neutral_limit, rounding);
}

/// Indices of the eigenvalues of least size that count as neutral.
std::vector<Index> neutral_of(const VectorXd& values, int modes) {
  std::vector<Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::sort(order, {}, [&](Index i) { return std::abs(values[i]); });
  if (modes < 0) {
    const double limit = limit_of(values);
    modes = static_cast<int>(std::ranges::count_if(
        order, [&](Index i) { return std::abs(values[i]) <= limit; }));
  }
  order.resize(std::min(order.size(), static_cast<std::size_t>(modes)));
  std::ranges::sort(order);
  return order;
}

Stability of_following_loads(StaticStrand& strand, const Balance& at,
                             const StaticStrand::Slopes& slopes) {
  Stability all;
  all.symmetric = false;
  const double unit =
      strand.bending() / (strand.strand().mass() * std::pow(strand.length(), 2));
  const std::vector<std::complex<double>> squares =
      squares_of_motions(strand.mass(at), slopes.stiffness, slopes.gradient,
                         slopes.gradient.transpose(), strand.typical());
  all.values.resize(std::ssize(squares));
  double largest = 0;
  for (const std::complex<double>& square : squares) {
    largest = std::max(largest, std::abs(square));
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    all.values[static_cast<Index>(i)] = squares[i].real() / unit;
    const double split = std::sqrt(eigenvalue_rounding * largest * std::abs(squares[i]));
    if (std::abs(squares[i].imag()) > split) all.oscillates = true;
  }
  all.neutral.resize(at.q.size(), 0);
  return all;
}

}  // namespace

Stability stability(StaticStrand& strand, const Balance& at, int neutral_modes) {
  const StaticStrand::Slopes slopes = strand.slopes(at);
  const Eigen::Map<const VectorXd> size(strand.typical().data(), strand.coordinates());
  const MatrixXd basis =
      size.asDiagonal() * complement(size.asDiagonal() * slopes.gradient);
  MatrixXd stiffness = basis.transpose() * slopes.stiffness * basis / strand.bending();
  const double largest = stiffness.size() > 0 ? stiffness.cwiseAbs().maxCoeff() : 0;
  const double skew = stiffness.size() > 0
                          ? (stiffness - stiffness.transpose()).cwiseAbs().maxCoeff()
                          : 0;
  Stability all;
  if (skew > slopes.rounding * largest) {
    all = of_following_loads(strand, at, slopes);
  } else {
    stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
    const auto [values, vectors] = symmetric_eigenpairs(
        stiffness, MatrixXd::Identity(stiffness.rows(), stiffness.cols()));
    const std::vector<Index> neutral = neutral_of(values, neutral_modes);
    std::vector<Index> others;
    for (Index i = 0; i < values.size(); ++i) {
      if (!std::ranges::binary_search(neutral, i)) others.push_back(i);
    }
    all.values = values(others);
    const VectorXd left_out = values(neutral).cwiseAbs();
    all.lifted = static_cast<int>((left_out.array() > lift * limit_of(values)).count());
    const double least = others.empty() ? std::numeric_limits<double>::infinity()
                                        : all.values.cwiseAbs().minCoeff();
    all.apart = all.lifted == 0 || left_out.maxCoeff() < 0.5 * least;
    all.shapes = basis * vectors(Eigen::all, others);
    all.neutral = basis * vectors(Eigen::all, neutral);
  }
  all.negative = static_cast<int>((all.values.array() < 0).count());
  return all;
}

}  // namespace tress::experiments::statics
