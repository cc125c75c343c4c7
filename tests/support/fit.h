#pragma once

#include <vector>

#include "experiments/harness/fit.h"

namespace tress::testing_support {

/// Slope of log error against log step by least squares.
inline double fitted_order(const std::vector<double>& steps,
                           const std::vector<double>& errors) {
  return log_log_slope(steps, errors);
}

}  // namespace tress::testing_support
