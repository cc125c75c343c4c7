#include "integrators/linear/direct_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "integrators/linear/finite.h"

namespace tress {
namespace {

/// Three sweeps undo units over 24 decades between neighbours in D P D, P Poisson's
/// matrix, to within a factor 20 of P's condition; four to within 2. Dividing rows, then
/// columns, leaves a factor 1e15.
constexpr int symmetric_sweeps = 3;

double length(In x) {
  double largest = 0;
  for (double v : x) largest = std::max(largest, std::abs(v));
  if (largest == 0 || !std::isfinite(largest)) return largest;
  double sum = 0;
  for (double v : x) sum += (v / largest) * (v / largest);
  return largest * std::sqrt(sum);
}

/// Signs without pattern (splitmix64 of the index), the same on every call.
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
      row_factor_(static_cast<std::size_t>(pattern.rows)),
      column_factor_(static_cast<std::size_t>(pattern.cols)),
      row_largest_(static_cast<std::size_t>(pattern.rows)),
      probe_(static_cast<std::size_t>(pattern.rows)) {
  if (pattern.rows != pattern.cols) {
    throw std::invalid_argument("linear solver: the matrix must be square");
  }
}

/// Multiplies by row_factor_ and column_factor_ and leaves there the largest magnitude of
/// each row and column of the result; norm_ is its 1-norm.
void DirectSolver::sweep() noexcept {
  std::ranges::fill(row_largest_, 0.0);
  norm_ = 0;
  for (std::size_t j = 0; j < column_factor_.size(); ++j) {
    double largest = 0;
    double sum = 0;
    for (auto p = static_cast<std::size_t>(pattern_.start[j]);
         p < static_cast<std::size_t>(pattern_.start[j + 1]); ++p) {
      const auto i = static_cast<std::size_t>(pattern_.row[p]);
      scaled_[p] *= row_factor_[i] * column_factor_[j];
      const double size = std::abs(scaled_[p]);
      row_largest_[i] = std::max(row_largest_[i], size);
      largest = std::max(largest, size);
      sum += size;
    }
    norm_ = std::max(norm_, sum);
    row_scale_[j] *= row_factor_[j];
    column_scale_[j] *= column_factor_[j];
    column_factor_[j] = largest;
  }
  row_factor_.swap(row_largest_);
}

bool DirectSolver::scale(In values) noexcept {
  if (!all_finite(values)) return false;
  std::ranges::copy(values, scaled_.begin());
  for (auto* v : {&row_scale_, &column_scale_, &row_factor_, &column_factor_}) {
    std::ranges::fill(*v, 1.0);
  }
  const auto is_zero = [](double largest) { return largest == 0; };
  for (int i = 0; i < symmetric_sweeps; ++i) {
    sweep();
    if (std::ranges::any_of(row_factor_, is_zero)) return false;
    if (std::ranges::any_of(column_factor_, is_zero)) return false;
    for (double& r : row_factor_) r = 1 / std::sqrt(r);
    for (double& c : column_factor_) c = 1 / std::sqrt(c);
  }
  sweep();
  std::ranges::fill(row_factor_, 1.0);
  for (double& c : column_factor_) c = 1 / c;
  sweep();
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
