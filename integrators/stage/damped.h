#pragma once

#include "integrators/stage/stage_equations.h"

namespace tress::integrators {

/// Newton's method with damped corrections: the whole correction, or its largest halving
/// that passes the natural monotonicity test. The test requires that the next correction
/// with the same matrix is smaller [Deuflhard 2011, Newton Methods for Nonlinear
/// Problems, section 3.3]. Used where Newton's method fails, as with long steps of shaken
/// strands: from the guess, from zero acceleration and from standstill.
///
/// Cost: each correction needs a matrix, and a residual and a solve for the correction
/// and for each halving. At most damped_patience times newton_iterations corrections are
/// taken.
class Damped {
 public:
  /// Works on `equations`, which must outlive it.
  explicit Damped(StageEquations& equations)
      : equations_(equations), start_(equations.dynamics), step_(start_), next_(start_) {}

  /// x: guess in, solution out.
  Status solve(Unknowns& x) noexcept;

 private:
  Status halve_until_smaller(double size, Unknowns& x) noexcept;

  StageEquations& equations_;
  Unknowns start_, step_, next_;  // of a correction, and the one after it
};

}  // namespace tress::integrators
