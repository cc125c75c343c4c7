#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "contract/layers.h"

namespace tress::models {

/// Whether Newton's iteration of one strand has converged: the rules of
/// integrators/stage.h, by the sizes of its corrections alone. A strand's iteration does
/// not depend on its neighbours then.
class NewtonJudge {
 public:
  struct Rules {
    double tolerance;  // of a correction
    double rounding;   // below it corrections that stop shrinking are rounding errors
    int iterations;
  };

  /// As Options' in integrators/stage.h, unless numbers resolve corrections of a size
  /// `resolved` only.
  static Rules rules(double tolerance, int iterations, double resolved) {
    return {std::max(tolerance, resolved / 2),
            std::max({tolerance, std::min(1e4 * tolerance, 1e-6), 4 * resolved}),
            iterations};
  }
  enum class Verdict { go_on, converged, failed };

  Verdict judge(const Rules& rules, double correction) {
    if (!std::isfinite(correction)) return Verdict::failed;
    const double rate = correction / previous_;
    // Of the error that is left the rate tells; the first correction has none yet.
    const double left =
        done_ > 0 && rate < 1 ? correction * rate / (1 - rate) : correction;
    if (correction <= rules.tolerance || left <= 0.1 * rules.tolerance) {
      return Verdict::converged;
    }
    if (rate > 0.5 && done_ >= 2 && correction <= rules.rounding) {
      return Verdict::converged;
    }
    if (rate > 1 && done_ > 0 && ++grown_ == most_grown) return Verdict::failed;
    previous_ = correction;
    return ++done_ == rules.iterations ? Verdict::failed : Verdict::go_on;
  }

 private:
  static constexpr int most_grown = 2;

  int done_ = 0, grown_ = 0;
  double previous_ = std::numeric_limits<double>::infinity();
};

}  // namespace tress::models
