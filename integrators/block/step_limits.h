#pragma once

#include <algorithm>
#include <cmath>

#include "integrators/block/block_method.h"
#include "integrators/control/step_factors.h"

namespace tress::integrators {

/// Limits of steps with error control, over the time sqrt(L/g) in which a strand falls by
/// its length.
struct StepLimits {
  double first;     // tried, if its motion starts smoothly
  double shortest;  // beyond rounding

  /// Returns the limits for numbers with relative resolution `epsilon`. Positions are
  /// known to epsilon L, so a stage of gamma h knows its acceleration to epsilon L/(gamma
  /// h)^2. The estimate of velocities then contains
  ///
  ///     h sum |rate_i| epsilon L/(gamma h)^2 sqrt(L/g)/L.
  ///
  /// Where that is above the threshold, shorter steps are worse.
  static StepLimits of(const BlockMethod& method, double tolerance, double epsilon) {
    const BlockEstimate& estimate = *method.estimate;
    const double threshold = estimate.threshold(tolerance),
                 gamma = method.stages.back().gamma;
    double seen = 0;
    for (const double rate : estimate.rate) seen += std::abs(rate);
    return {step_factors::first_part * std::pow(threshold, 1 / estimate.falls),
            std::max(step_factors::shortest_part,
                     seen * epsilon / (gamma * gamma * threshold))};
  }
};

}  // namespace tress::integrators
