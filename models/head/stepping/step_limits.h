#pragma once

#include <algorithm>
#include <cmath>

#include "models/head/stepping/lane_method.h"

namespace tress::models {

/// Of steps with error control, over the time sqrt(L/g) in which a strand falls by its
/// length.
struct StepLimits {
  double first;     // tried, if its motion starts smoothly
  double shortest;  // beyond rounding

  /// Of numbers that resolve `epsilon` of themselves. They know places to epsilon L, so
  /// that a stage of gamma h knows its acceleration to epsilon L/(gamma h)^2, of which
  /// the estimate of velocities sees
  ///
  ///     h sum |rate_i| epsilon L/(gamma h)^2 sqrt(L/g)/L.
  ///
  /// Where that is above the threshold shorter steps are worse. The first part and the
  /// shortest one of any numbers are those of integrators/control/error_controlled.cpp.
  static StepLimits of(const LaneMethod& method, double tolerance, double epsilon) {
    constexpr double first_part = 0.1, shortest_part = 1e-11;
    const LaneEstimate& estimate = *method.estimate;
    const double threshold = estimate.threshold(tolerance),
                 gamma = method.stages.back().gamma;
    double seen = 0;
    for (const double rate : estimate.rate) seen += std::abs(rate);
    return {first_part * std::pow(threshold, 1 / estimate.falls),
            std::max(shortest_part, seen * epsilon / (gamma * gamma * threshold))};
  }
};

}  // namespace tress::models
