#include "linear/skyline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress {

Skyline::Skyline(const std::vector<std::size_t>& first) : first_(first) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    start_.push_back(count);
    count += i - first_[i] + 1;
  }
  value_.resize(count);
}

void Skyline::clear() { std::ranges::fill(value_, 0.0); }

void Skyline::add(const Skyline& other) {
  for (std::size_t i = 0; i < value_.size(); ++i) value_[i] += other.value_[i];
}

bool Skyline::factor() noexcept {
  for (std::size_t i = 0; i < size(); ++i) {
    double* const row = &value_[start_[i]];
    for (std::size_t j = first_[i]; j < i; ++j) {
      const double* const above = &value_[start_[j]];
      double sum = row[j - first_[i]];
      for (std::size_t k = std::max(first_[i], first_[j]); k < j; ++k) {
        sum -= row[k - first_[i]] * above[k - first_[j]];
      }
      row[j - first_[i]] = sum / above[j - first_[j]];
    }
    double& diagonal = row[i - first_[i]];
    const double before = diagonal;
    for (std::size_t k = first_[i]; k < i; ++k) {
      diagonal -= row[k - first_[i]] * row[k - first_[i]];
    }
    if (!(diagonal > std::numeric_limits<double>::epsilon() * before)) return false;
    diagonal = std::sqrt(diagonal);
  }
  return true;
}

void Skyline::solve(InOut b) const noexcept {
  for (std::size_t i = 0; i < size(); ++i) {
    const double* const row = &value_[start_[i]];
    for (std::size_t k = first_[i]; k < i; ++k) b[i] -= row[k - first_[i]] * b[k];
    b[i] /= row[i - first_[i]];
  }
  for (std::size_t i = size(); i-- > 0;) {
    const double* const row = &value_[start_[i]];
    b[i] /= row[i - first_[i]];
    for (std::size_t k = first_[i]; k < i; ++k) b[k] -= row[k - first_[i]] * b[i];
  }
}

}  // namespace tress
