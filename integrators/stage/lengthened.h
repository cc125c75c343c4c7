#pragma once

#include "integrators/stage/continuation.h"

namespace tress::integrators {

/// A tenth of the step is solved, then a gradually longer part of it until it is whole
/// [Deuflhard 2011, Newton Methods for Nonlinear Problems, section 5.1], each by damped
/// corrections from an extrapolation. Tried where damped corrections fail: first with the
/// drift of the whole step, for soft strands that fall far in one step; then with the
/// drift of the part, for strands that turn fast, which the drift of the whole step
/// carries out of reach of any guess. Where that gets stuck, Continuation goes on.
///
/// Cost: that of Damped for each part. A part that fails is followed by a shorter one,
/// growth falling to 1.05, so a step that can be solved takes about ten.
class Lengthened {
 public:
  using Drift = StageEquations::Drift;

  Lengthened(StageEquations& equations, Damped& damped, Continuation& continuation)
      : equations_(equations),
        damped_(damped),
        continuation_(continuation),
        solved_(equations.dynamics),
        before_(solved_) {}

  /// From standstill; x: multipliers in, solution out.
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
