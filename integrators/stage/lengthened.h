#pragma once

#include "integrators/stage/continuation.h"

namespace tress::integrators {

/// Solves a tenth of the step, then a gradually longer part until it is whole [Deuflhard
/// 2011, Newton Methods for Nonlinear Problems, section 5.1]. Each part is solved by
/// damped corrections from an extrapolation. Used where damped corrections fail. The
/// drift of the whole step comes first, for soft strands that fall far in one step. The
/// drift of the part follows, for strands that turn fast: the drift of the whole step
/// would carry them out of reach of any guess. Where that stalls, Continuation follows.
///
/// Cost: that of Damped for each part. After a part that fails, a shorter one follows
/// with growth down to 1.05, so a step that can be solved takes about ten.
class Lengthened {
 public:
  /// Force-free motion of a part of the step.
  using Drift = StageEquations::Drift;

  /// Works on `equations` with these methods, all of which must outlive it.
  Lengthened(StageEquations& equations, Damped& damped, Continuation& continuation)
      : equations_(equations),
        damped_(damped),
        continuation_(continuation),
        solved_(equations.dynamics),
        before_(solved_) {}

  /// Solves from standstill; x: multipliers in, solution out.
  Status solve(Drift drift, Unknowns& x) noexcept {
    const Status s = lengthen(drift, x);
    equations_.take_whole();
    return s;
  }

 private:
  Status lengthen(Drift drift, Unknowns& x) noexcept;

  StageEquations& equations_;
  Damped& damped_;
  Continuation& continuation_;
  Unknowns solved_, before_;  // the longest part solved, and the one before it
};

}  // namespace tress::integrators
