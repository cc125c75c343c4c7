#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace tress::experiments::family {

/// Values between two ends by a position u in [0, 1].
struct Range {
  double low, high;
  double at(double u) const { return low + u * (high - low); }
  double log_at(double u) const { return low * std::pow(high / low, u); }
};

/// u-quantile of the normal distribution of mean 0 and variance 1; finite at 0 and 1.
double normal_quantile(double u);

/// The distribution of x where ln x is normal.
struct LogNormal {
  double median, sigma;
  double at(double u) const { return median * std::exp(sigma * normal_quantile(u)); }
};

/// The normal distribution between two ends, none outside.
struct CutNormal {
  double mean, sigma, low, high;
  double at(double u) const;
};

/// The coordinates of a Latin hypercube: one of all members is a random position within
/// each of `count` equal parts of [0, 1), in random order.
class Hypercube {
 public:
  /// Dimensions `first`, `first` + 1, ... of the streams of `seed`.
  Hypercube(int count, std::uint64_t seed, std::uint64_t first);

  /// The next dimension.
  std::vector<double> next();

 private:
  int count_;
  std::uint64_t seed_, dimension_;
};

}  // namespace tress::experiments::family
