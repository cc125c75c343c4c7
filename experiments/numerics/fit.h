#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "contract/layers.h"

namespace tress::experiments {

/// Slope of log y against log x by least squares, the exponent p of y ~ x^p. All entries
/// must be positive, with at least two different x.
inline double log_log_slope(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double x_mean = 0, y_mean = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    x_mean += std::log(x[i]) / n;
    y_mean += std::log(y[i]) / n;
  }
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - x_mean;
    xx += dx * dx;
    xy += dx * (std::log(y[i]) - y_mean);
  }
  return xy / xx;
}

}  // namespace tress::experiments
