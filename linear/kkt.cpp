#include "linear/kkt.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/finite.h"

namespace tress {
namespace {

/// A constraint whose independent part is `dependence` gives a condition of its inverse
/// square, 1e16; the estimate may be low by some powers of ten.
constexpr double suspicious_condition = 1e11;
/// Independent constraints found at a high condition: check again when it is this much
/// higher.
constexpr double suspicion_growth = 100;
/// With delta each pass gains eight digits for eigenvalues of A near one (all are at most
/// the number of constraints that share a coordinate).
constexpr double regularisation = 1e-8;
constexpr int most_refinements = 12;
/// A refined residual larger than this indicates a singular matrix.
constexpr double refined_residual = 1e-9;

double largest_magnitude(In x) {
  double largest = 0;
  for (double v : x) largest = std::max(largest, std::abs(v));
  return largest;
}

std::size_t place(int i) { return static_cast<std::size_t>(i); }

/// Calls visit(row, column, entry) for every entry.
template <class Visit>
void for_each_entry(const Pattern& pattern, Visit visit) {
  for (std::size_t j = 0; j < place(pattern.cols); ++j) {
    for (std::size_t p = place(pattern.start[j]); p < place(pattern.start[j + 1]); ++p) {
      visit(place(pattern.row[p]), j, p);
    }
  }
}

}  // namespace

Kkt::Kkt(LinearKind kind, const Pattern& s, const Pattern& gt)
    : s_(s),
      gt_(gt),
      matrix_(s.rows + gt.cols, s.cols + gt.cols),
      s_block_(matrix_.add_block(s, 0, 0)),
      g_block_(matrix_.add_block(gt, 0, s.cols)),
      h_block_(matrix_.add_block(gt, s.rows, 0, true)),
      delta_block_(matrix_.add_block(identity_pattern(gt.cols), s.rows, s.cols)),
      diagonal_(place(s.cols), -1),
      delta_(place(gt.cols)),
      suspicious_(suspicious_condition) {
  matrix_.finish();
  solver_ = make_linear_solver(kind, matrix_.pattern());
  report_.solver = solver_->name();
  for_each_entry(s_, [this](std::size_t i, std::size_t j, std::size_t p) {
    if (i == j) diagonal_[i] = static_cast<int>(p);
  });
  scaled_.resize(place(matrix_.pattern().nonzeros()));
  for (auto* v : {&row_scale_, &column_scale_, &right_, &residual_, &unknown_}) {
    v->resize(place(s.cols + gt.cols));
  }
}

Kkt::~Kkt() = default;

/// D = |S_ii|^-1/2, then E and F: reciprocal lengths of the columns of D G^T and D H^T.
void Kkt::scale(In s, In gt, In ht) noexcept {
  const std::size_t n = diagonal_.size();
  bool massless = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double size = diagonal_[i] < 0 ? 0.0 : std::abs(s[place(diagonal_[i])]);
    column_scale_[i] = size > 0 ? 1 / std::sqrt(size) : 0.0;
    massless = massless || size == 0;
  }
  if (massless) scale_massless(s, gt);
  std::copy_n(column_scale_.begin(), n, row_scale_.begin());

  const auto reciprocal_lengths = [&](In gradients, std::vector<double>& target) {
    for (std::size_t k = 0; k < delta_.size(); ++k) {
      double sum = 0;
      for (std::size_t p = place(gt_.start[k]); p < place(gt_.start[k + 1]); ++p) {
        const double part = gradients[p] * column_scale_[place(gt_.row[p])];
        sum += part * part;
      }
      target[n + k] = sum > 0 ? 1 / std::sqrt(sum) : 1.0;
    }
  };
  reciprocal_lengths(gt, column_scale_);
  reciprocal_lengths(ht, row_scale_);
}

/// Coordinates without a diagonal in S: their largest coupling to a coordinate that has
/// one becomes 1; failing that, their largest share in a constraint.
void Kkt::scale_massless(In s, In gt) noexcept {
  const std::size_t n = diagonal_.size();
  std::vector<double>& d = column_scale_;
  std::vector<double>& coupling = unknown_;
  std::ranges::fill(coupling, 0.0);
  for_each_entry(s_, [&](std::size_t i, std::size_t j, std::size_t p) {
    coupling[j] = std::max(coupling[j], std::abs(s[p]) * d[i]);
    coupling[i] = std::max(coupling[i], std::abs(s[p]) * d[j]);
  });
  std::vector<double>& length = residual_;
  std::ranges::fill(length, 0.0);
  for_each_entry(gt_, [&](std::size_t i, std::size_t k, std::size_t p) {
    length[k] = std::hypot(length[k], gt[p] * d[i]);
  });
  std::vector<double>& share = right_;
  std::ranges::fill(share, 0.0);
  for_each_entry(gt_, [&](std::size_t i, std::size_t k, std::size_t p) {
    const double unit = length[k] > 0 ? length[k] : 1.0;
    share[i] = std::max(share[i], std::abs(gt[p]) / unit);
  });
  for (std::size_t i = 0; i < n; ++i) {
    if (d[i] > 0) continue;
    const double size = coupling[i] > 0 ? coupling[i] : share[i];
    d[i] = size > 0 ? 1 / size : 1.0;
  }
}

void Kkt::assemble(In s, In gt, In ht, double delta) noexcept {
  const std::size_t n = diagonal_.size();
  shift_ = delta;
  matrix_.clear();
  matrix_.add(s_block_, 1, s);
  matrix_.add(g_block_, -1, gt);
  matrix_.add(h_block_, 1, ht);
  if (delta > 0) {
    for (std::size_t k = 0; k < delta_.size(); ++k) {
      delta_[k] = delta / (row_scale_[n + k] * column_scale_[n + k]);
    }
    matrix_.add(delta_block_, 1, delta_);
  }
  const In values = matrix_.values();
  for_each_entry(matrix_.pattern(), [&](std::size_t i, std::size_t j, std::size_t p) {
    scaled_[p] = row_scale_[i] * values[p] * column_scale_[j];
  });
}

Status Kkt::factor_assembled() noexcept {
  const Status status = solver_->factor(scaled_);
  report_.condition = solver_->condition();
  return status;
}

Status Kkt::factor(In s, In gt, In ht) noexcept {
  if (!all_finite(s) || !all_finite(gt) || !all_finite(ht)) return Status::retry;
  scale(s, gt, ht);
  if (report_.rank_deficiency > 0) return factor_redundant(s, gt, ht);

  assemble(s, gt, ht, 0);
  const Status status = factor_assembled();
  if (report_.condition < suspicious_condition) suspicious_ = suspicious_condition;
  if (delta_.empty() || (status == Status::ok && report_.condition <= suspicious_)) {
    return status;
  }
  return factor_redundant(s, gt, ht);
}

/// Counts redundant constraints and factors accordingly.
Status Kkt::factor_redundant(In s, In gt, In ht) {
  const std::size_t n = diagonal_.size();
  const In columns = In(column_scale_);
  const In rows = In(row_scale_);
  null_g_ = std::make_unique<NullSpace>(gt_, gt, columns.first(n), columns.subspan(n));
  null_h_ = std::make_unique<NullSpace>(gt_, ht, rows.first(n), rows.subspan(n));
  report_.rank_deficiency = null_g_->dimension();
  // Different ranks of G and H leave x undetermined.
  if (null_g_->dimension() != null_h_->dimension()) return Status::retry;

  assemble(s, gt, ht, report_.rank_deficiency > 0 ? regularisation : 0);
  const Status status = factor_assembled();
  if (report_.rank_deficiency == 0) suspicious_ = suspicion_growth * report_.condition;
  return status;
}

/// residual = right - K unknown, with K free of delta.
void Kkt::subtract_product() noexcept {
  const std::size_t n = diagonal_.size();
  residual_ = right_;
  for_each_entry(matrix_.pattern(), [&](std::size_t i, std::size_t j, std::size_t p) {
    residual_[i] -= scaled_[p] * unknown_[j];
  });
  for (std::size_t k = n; k < residual_.size(); ++k) residual_[k] += shift_ * unknown_[k];
}

/// Iterates until the residual stops halving.
Status Kkt::refine() noexcept {
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_refinements; ++pass) {
    subtract_product();
    const double now = largest_magnitude(residual_);
    if (!(now < before / 2)) break;
    before = now;
    if (solver_->solve(residual_) != Status::ok) return Status::retry;
    for (std::size_t i = 0; i < unknown_.size(); ++i) unknown_[i] += residual_[i];
  }
  const double size = std::max(largest_magnitude(right_), largest_magnitude(unknown_));
  return before <= refined_residual * size ? Status::ok : Status::retry;
}

Status Kkt::solve(InOut b, InOut c) noexcept {
  const std::size_t n = b.size();
  const bool redundant = report_.rank_deficiency > 0;
  if (redundant) null_h_->project_out(c);
  for (std::size_t i = 0; i < n; ++i) right_[i] = row_scale_[i] * b[i];
  for (std::size_t k = 0; k < c.size(); ++k) right_[n + k] = row_scale_[n + k] * c[k];
  unknown_ = right_;
  Status status = solver_->solve(unknown_);
  // Without redundancy one solve is enough: a refinement step gained a factor 1 to 5 in x
  // and y on chains with conditions from 10 to 1e10, far below what integrators require.
  if (redundant && status == Status::ok) status = refine();
  if (status != Status::ok) return status;
  for (std::size_t i = 0; i < n; ++i) b[i] = column_scale_[i] * unknown_[i];
  for (std::size_t k = 0; k < c.size(); ++k)
    c[k] = column_scale_[n + k] * unknown_[n + k];
  if (redundant) null_g_->project_out(c);
  return Status::ok;
}

}  // namespace tress
