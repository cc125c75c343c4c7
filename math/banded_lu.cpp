#include "math/banded_lu.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tress {

BandedLu::BandedLu(int n, int lower, int upper)
    : n_(n), lower_(lower), reach_(lower + upper), width_(lower_ + reach_ + 1) {
  band_.resize(static_cast<std::size_t>(n_) * static_cast<std::size_t>(width_));
  pivot_.resize(static_cast<std::size_t>(n_));
}

void BandedLu::clear() { std::fill(band_.begin(), band_.end(), 0.0); }

bool BandedLu::factor() noexcept {
  for (int k = 0; k < n_; ++k) {
    const int below = std::min(k + lower_, n_ - 1);
    const int right = std::min(k + reach_, n_ - 1);
    int p = k;
    for (int i = k + 1; i <= below; ++i) {
      if (std::abs(at(i, k)) > std::abs(at(p, k))) p = i;
    }
    pivot_[static_cast<std::size_t>(k)] = p;
    const double largest = std::abs(at(p, k));
    if (!(largest > 0) || !std::isfinite(largest)) return false;
    if (p != k) {
      for (int j = k; j <= right; ++j) std::swap(at(k, j), at(p, j));
    }
    for (int i = k + 1; i <= below; ++i) {
      const double factor = at(i, k) /= at(k, k);
      if (factor == 0) continue;
      for (int j = k + 1; j <= right; ++j) at(i, j) -= factor * at(k, j);
    }
  }
  return true;
}

void BandedLu::solve(std::span<double> x) const noexcept {
  const auto entry = [&](int i) -> double& { return x[static_cast<std::size_t>(i)]; };
  for (int k = 0; k < n_; ++k) {
    std::swap(entry(k), entry(pivot_[static_cast<std::size_t>(k)]));
    for (int i = k + 1; i <= std::min(k + lower_, n_ - 1); ++i) {
      entry(i) -= band_[index(i, k)] * entry(k);
    }
  }
  for (int i = n_ - 1; i >= 0; --i) {
    for (int j = i + 1; j <= std::min(i + reach_, n_ - 1); ++j) {
      entry(i) -= band_[index(i, j)] * entry(j);
    }
    entry(i) /= band_[index(i, i)];
  }
}

}  // namespace tress
