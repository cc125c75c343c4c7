#include "linear/bordered.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/dense_lu.h"
#include "linear/finite.h"
#include "linear/vector_ops.h"

namespace tress {
namespace {

/// A constraint whose independent part is NullSpace::dependence leaves a pivot of its
/// square, below rounding.
constexpr double suspicious_condition = 1e11;
/// The smallest eigenvalues of the scaled W that are not 0 gain eight digits a pass.
constexpr double regularisation = 1e-8;
constexpr int most_refinements = 12;
/// A refined residual larger than this indicates a singular matrix.
constexpr double refined_residual = 1e-9;

std::size_t place(Eigen::Index i) { return static_cast<std::size_t>(i); }

}  // namespace

struct Bordered::Matrices {
  Matrices(Eigen::Index n, Eigen::Index m)
      : responses(n, m),
        scaled(m, m),
        factored(m, m),
        scale(m),
        right(m),
        left(m),
        found(m),
        correction(m),
        lu(m) {}

  Eigen::MatrixXd responses;                       // Y (n x m)
  Eigen::MatrixXd scaled, factored;                // W, and W with delta, scaled
  Eigen::VectorXd scale;                           // (m)
  Eigen::VectorXd right, left, found, correction;  // (m), scaled
  DenseLu lu;
};

Bordered::Bordered(std::function<Status(InOut)> solve, const Pattern& gt, In typical)
    : solve_(std::move(solve)),
      gt_(gt),
      typical_(typical.begin(), typical.end()),
      ht_(place(gt.nonzeros())),
      of_(std::make_unique<Matrices>(gt.rows, gt.cols)) {
  report_.solver = "bordered";
}

Bordered::~Bordered() = default;

/// c -= H x.
void Bordered::subtract_rows(In x, InOut c) const noexcept {
  for (std::size_t k = 0; k < c.size(); ++k) {
    for (auto p = place(gt_.start[k]); p < place(gt_.start[k + 1]); ++p) {
      c[k] -= ht_[p] * x[place(gt_.row[p])];
    }
  }
}

Status Bordered::factor(In gt, In ht) noexcept {
  if (!all_finite(gt) || !all_finite(ht)) return Status::retry;
  std::ranges::copy(ht, ht_.begin());
  const Eigen::Index n = of_->responses.rows(), m = of_->responses.cols();
  of_->responses.setZero();
  for (Eigen::Index k = 0; k < m; ++k) {
    for (auto p = place(gt_.start[place(k)]); p < place(gt_.start[place(k) + 1]); ++p) {
      of_->responses(gt_.row[p], k) = gt[p];
    }
    const Status s = solve_({of_->responses.col(k).data(), place(n)});
    if (s != Status::ok) return s;
  }
  for (Eigen::Index k = 0; k < m; ++k) {
    double terms = 0;
    for (Eigen::Index j = 0; j < m; ++j) of_->scaled(k, j) = 0;
    for (auto p = place(gt_.start[place(k)]); p < place(gt_.start[place(k) + 1]); ++p) {
      const Eigen::Index i = gt_.row[p];
      terms += std::abs(ht[p] * of_->responses(i, k));
      for (Eigen::Index j = 0; j < m; ++j)
        of_->scaled(k, j) += ht[p] * of_->responses(i, j);
    }
    of_->scale[k] = terms > 0 ? 1 / std::sqrt(terms) : 1;
  }
  if (!of_->scaled.allFinite() || !of_->scale.allFinite()) return Status::retry;
  of_->scaled = of_->scale.asDiagonal() * of_->scaled * of_->scale.asDiagonal();
  if (report_.rank_deficiency > 0) return factor_redundant(gt, ht);
  of_->factored = of_->scaled;
  const double least = of_->lu.factor(of_->factored);
  report_.condition = least > 0 ? of_->factored.cwiseAbs().maxCoeff() / least
                                : std::numeric_limits<double>::infinity();
  if (m == 0 || report_.condition <= suspicious_condition) return Status::ok;
  return factor_redundant(gt, ht);
}

/// Counts redundant constraints and factors accordingly.
Status Bordered::factor_redundant(In gt, In ht) {
  const auto null_space = [&](In gradients) {
    std::vector<double> unit(place(of_->scale.size()));
    for (std::size_t k = 0; k < unit.size(); ++k) {
      double sum = 0;
      for (auto p = place(gt_.start[k]); p < place(gt_.start[k + 1]); ++p) {
        sum += std::pow(gradients[p] * typical_[place(gt_.row[p])], 2);
      }
      unit[k] = sum > 0 ? 1 / std::sqrt(sum) : 1;
    }
    return std::make_unique<NullSpace>(gt_, gradients, typical_, unit);
  };
  null_g_ = null_space(gt);
  null_h_ = null_space(ht);
  report_.rank_deficiency = null_g_->dimension();
  // Different ranks of G and H leave x undetermined.
  if (null_g_->dimension() != null_h_->dimension()) return Status::retry;
  of_->factored = of_->scaled;
  if (report_.rank_deficiency > 0) of_->factored.diagonal().array() += regularisation;
  const double least = of_->lu.factor(of_->factored);
  if (!(least > 0)) return Status::retry;
  report_.condition = of_->factored.cwiseAbs().maxCoeff() / least;
  return Status::ok;
}

/// of_->found = W^-1 of_->right, scaled; iterates until the residual stops halving where
/// W has delta.
Status Bordered::solve_for_multipliers() noexcept {
  of_->found = of_->right;
  of_->lu.solve(of_->found);
  if (report_.rank_deficiency == 0) return Status::ok;
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_refinements; ++pass) {
    of_->left = of_->right;
    of_->left.noalias() -= of_->scaled * of_->found;
    const double now = of_->left.cwiseAbs().maxCoeff();
    if (!(now < before / 2)) break;
    before = now;
    of_->correction = of_->left;
    of_->lu.solve(of_->correction);
    of_->found += of_->correction;
  }
  const double size =
      std::max(of_->right.cwiseAbs().maxCoeff(), of_->found.cwiseAbs().maxCoeff());
  return before <= refined_residual * size ? Status::ok : Status::retry;
}

Status Bordered::solve(InOut b, InOut c) noexcept {
  const bool redundant = report_.rank_deficiency > 0;
  if (const Status s = solve_(b); s != Status::ok) return s;
  subtract_rows(b, c);
  if (redundant) null_h_->project_out(c);
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    of_->right[at] = of_->scale[at] * c[k];
  }
  if (const Status s = solve_for_multipliers(); s != Status::ok) return s;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    c[k] = of_->scale[at] * of_->found[at];
  }
  if (redundant) null_g_->project_out(c);
  for (std::size_t k = 0; k < c.size(); ++k) {
    add(b, c[k], {of_->responses.col(static_cast<Eigen::Index>(k)).data(), b.size()});
  }
  return all_finite(b) && all_finite(c) ? Status::ok : Status::retry;
}

}  // namespace tress
