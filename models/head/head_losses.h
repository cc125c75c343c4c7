#pragma once

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string_view>
#include <vector>

#include "models/head/head.h"

namespace tress::models {

/// Failed strands that several threads report.
class HeadLosses {
 public:
  /// Reports a strand that failed in the step from t to t + h (s), after the fraction
  /// `part` of the step.
  void add(std::size_t strand, double t, double h, std::string_view reason,
           double part = 0) {
    const std::scoped_lock lock(guard_);
    all_.push_back({strand, std::lround(t / h) + 1, t + part * h, reason});
  }
  /// See Head::losses().
  std::vector<HeadLoss> after(std::size_t known) const {
    const std::scoped_lock lock(guard_);
    std::vector<HeadLoss> rest(all_.begin() + static_cast<std::ptrdiff_t>(known),
                               all_.end());
    std::ranges::sort(rest, {}, &HeadLoss::strand);
    return rest;
  }

 private:
  mutable std::mutex guard_;
  std::vector<HeadLoss> all_;
};

}  // namespace tress::models
