#pragma once

#include "integrators/stage/stage_equations.h"

namespace tress::integrators {

/// Newton's method with damped corrections: the whole one, or the largest halving of it
/// for which the next correction with the same matrix is smaller (the natural
/// monotonicity test) [Deuflhard 2011, Newton Methods for Nonlinear Problems, section
/// 3.3]. Tried where Newton's method fails, as with long steps of shaken strands: from
/// the guess, from zero acceleration and from standstill.
///
/// Cost: a matrix for each correction, of which damped_patience times newton_iterations
/// are allowed, and a residual and a solve for it and for each halving.
class Damped {
 public:
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
