#include "linear/direct_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "linear/finite.h"

namespace tress {
namespace {

/// For D P D, with P Poisson's matrix and units that differ by 24 decades between
/// neighbours, three sweeps restore P's condition to within a factor 20; four to within
/// 2. Dividing rows, then columns, leaves a factor 1e15.
constexpr int symmetric_sweeps = 3;

double length(In x) {
  double largest = 0;
  for (double v : x) largest = std::max(largest, std::abs(v));
  if (largest == 0 || !std::isfinite(largest)) return largest;
  double sum = 0;
  for (double v : x) sum += (v / largest) * (v / largest);
  return largest * std::sqrt(sum);
}

/// Pseudo-random signs (splitmix64 of the index), the same on every call.
double scattered_sign(std::uint64_t i) {
  i += 0x9e3779b97f4a7c15ULL;
  i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9ULL;
  i = (i ^ (i >> 27)) * 0x94d049bb133111ebULL;
  return ((i ^ (i >> 31)) & 1U) != 0 ? 1.0 : -1.0;
}

}  // namespace

DirectSolver::DirectSolver(const Pattern& pattern, double singular_pivot)
    : pattern_(pattern),
      singular_pivot_(singular_pivot),
      scaled_(static_cast<std::size_t>(pattern.nonzeros())),
      row_scale_(static_cast<std::size_t>(pattern.rows)),
      column_scale_(static_cast<std::size_t>(pattern.cols)),
      row_largest_(static_cast<std::size_t>(pattern.rows)),
      column_largest_(static_cast<std::size_t>(pattern.cols)),
      probe_(static_cast<std::size_t>(pattern.rows)) {
  if (pattern.rows != pattern.cols) {
    throw std::invalid_argument("linear solver: the matrix must be square");
  }
}

/// The largest magnitude in each row and column of R A C.
void DirectSolver::measure(In values) noexcept {
  std::ranges::fill(row_largest_, 0.0);
  for (std::size_t j = 0; j < column_scale_.size(); ++j) {
    double largest = 0;
    for (auto p = static_cast<std::size_t>(pattern_.start[j]);
         p < static_cast<std::size_t>(pattern_.start[j + 1]); ++p) {
      const auto i = static_cast<std::size_t>(pattern_.row[p]);
      const double size = std::abs(values[p]) * row_scale_[i] * column_scale_[j];
      row_largest_[i] = std::max(row_largest_[i], size);
      largest = std::max(largest, size);
    }
    column_largest_[j] = largest;
  }
}

bool DirectSolver::scale(In values) noexcept {
  if (!all_finite(values)) return false;
  std::ranges::fill(row_scale_, 1.0);
  std::ranges::fill(column_scale_, 1.0);
  const auto is_zero = [](double largest) { return largest == 0; };
  for (int k = 0; k < symmetric_sweeps; ++k) {
    measure(values);
    if (std::ranges::any_of(row_largest_, is_zero)) return false;
    if (std::ranges::any_of(column_largest_, is_zero)) return false;
    for (std::size_t i = 0; i < row_scale_.size(); ++i) {
      row_scale_[i] /= std::sqrt(row_largest_[i]);
      column_scale_[i] /= std::sqrt(column_largest_[i]);
    }
  }
  norm_ = 0;
  for (std::size_t j = 0; j < column_scale_.size(); ++j) {
    const auto first = static_cast<std::size_t>(pattern_.start[j]);
    const auto last = static_cast<std::size_t>(pattern_.start[j + 1]);
    double largest = 0, sum = 0;
    for (std::size_t p = first; p < last; ++p) {
      scaled_[p] = values[p] * row_scale_[static_cast<std::size_t>(pattern_.row[p])];
      largest = std::max(largest, std::abs(scaled_[p]));
      sum += std::abs(scaled_[p]);
    }
    column_scale_[j] = 1 / largest;
    for (std::size_t p = first; p < last; ++p) scaled_[p] *= column_scale_[j];
    norm_ = std::max(norm_, sum * column_scale_[j]);
  }
  return true;
}

Status DirectSolver::factor(In values) noexcept {
  condition_ = 0;
  factored_ = scale(values) && factor_scaled(scaled_) > singular_pivot_;
  return factored_ ? Status::ok : Status::retry;
}

Status DirectSolver::solve(InOut b) noexcept {
  if (!factored_) return Status::retry;
  for (std::size_t i = 0; i < b.size(); ++i) b[i] *= row_scale_[i];
  solve_scaled(b);
  for (std::size_t i = 0; i < b.size(); ++i) b[i] *= column_scale_[i];
  return all_finite(b) ? Status::ok : Status::retry;
}

/// |(R A C)^-1 x| / |x|; x becomes the unit vector along the solution.
double DirectSolver::amplification(InOut x) const noexcept {
  const double before = length(x);
  solve_scaled(x);
  const double after = length(x);
  for (double& v : x) v /= after;
  return after / before;
}

double DirectSolver::condition() const noexcept {
  if (!factored_) return std::numeric_limits<double>::infinity();
  if (condition_ == 0) {
    for (std::size_t i = 0; i < probe_.size(); ++i) probe_[i] = scattered_sign(i);
    const double first = amplification(probe_);
    const double second = amplification(probe_);
    condition_ = norm_ * std::max(first, second);
    if (!std::isfinite(condition_)) condition_ = std::numeric_limits<double>::infinity();
  }
  return condition_;
}

}  // namespace tress
