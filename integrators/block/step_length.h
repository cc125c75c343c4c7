#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "integrators/control/step_factors.h"

namespace tress::integrators {

/// Length of a strand's next step, by elementary error control: an estimated error that
/// falls as h^falls stays below its threshold [Hairer, Wanner 1996, section IV.8]. Steps
/// are power-of-two parts of an interval, the largest ones that are no longer than this
/// length. Most steps are therefore shorter by up to a half, which acts as the dead band
/// of StepControl. Its proportional part is absent: it would mistake an unchanged step
/// for one that the error requires. A step without a solution sets a ceiling, as in
/// StepControl, since the estimate does not reveal the cause. Lengths are in the block's
/// units.
class StepLength {
 public:
  /// Returns the length of the next step.
  double next() const { return std::min(next_, ceiling_); }
  /// Returns true after begin(), accept() or reject() has set a length.
  bool begun() const { return next_ > 0; }
  /// Starts with steps of h.
  void begin(double h) { next_ = h; }

  /// A step of h was taken with this estimate over its threshold, at most 1.
  void accept(double h, double error, double falls) {
    const double factor = factor_of(error, falls);
    // A step that was cut says nothing against more than it allows.
    next_ = factor > step_factors::most ? std::max(next_, step_factors::most * h)
                                        : std::max(factor, step_factors::least) * h;
    ceiling_ *= step_factors::ceiling_growth;
  }
  /// `error`: as above, more than 1 or not a number.
  void reject(double h, double error, double falls) {
    const double factor = factor_of(error, falls);
    next_ = (factor > step_factors::least ? factor : step_factors::least) * h;
  }
  /// Shortens the next step after one of h without a solution, and sets the ceiling.
  void unsolved(double h) {
    next_ = step_factors::unsolved * h;
    ceiling_ = step_factors::unsolved_ceiling * h;
  }

  static constexpr std::size_t kept = 2;  // Number of entries that keep() writes.
  /// Writes the state for checkpoints; returns the place behind it.
  double* keep(double* to) const {
    to[0] = next_;
    to[1] = ceiling_;
    return to + kept;
  }
  /// Restores what keep() wrote; returns the place behind it.
  const double* recall(const double* from) {
    next_ = from[0];
    ceiling_ = from[1];
    return from + kept;
  }

 private:
  static double factor_of(double error, double falls) {
    return step_factors::safety * std::pow(error, -1 / falls);
  }

  double next_ = 0;  // 0: the first is not chosen yet
  double ceiling_ = std::numeric_limits<double>::max();
};

}  // namespace tress::integrators
