#pragma once

#include "integrators/stage/stage_equations.h"

namespace tress::integrators {

/// A solution on a jump of the forces, such as that of a contact whose location switches.
/// There may be no solution in the ordinary sense: the step from either side of the jump
/// leads to the other. The solution is then taken in the sense of [Filippov 1988]: the
/// state on the jump at which a mean of the forces of both sides solves the equations.
/// There a mean of Newton's corrections from both sides vanishes.
///
/// Tried where Newton's method fails and its iterates alternate between two states.
///
/// Cost: a matrix, a residual and a solve for each bisection, about 30 to close in on the
/// jump, which happens again until the mean vanishes.
class Jump {
 public:
  /// Works on `equations`, which must outlive it.
  explicit Jump(StageEquations& equations)
      : equations_(equations),
        here_(equations.dynamics),
        there_(here_),
        middle_(here_),
        mean_(equations.dynamics) {}

  /// x: where Newton's method ended in, solution out. `rate`: its last correction over
  /// the one before; `retry` unless its iterates alternate there.
  Status solve(double rate, Unknowns& x) noexcept;

 private:
  /// A point near a jump, and Newton's correction there.
  struct Side {
    explicit Side(const Dynamics& dynamics) : x(dynamics), step(dynamics) {}
    Unknowns x, step;
    double size = 0;  // of the step
  };
  Status correct(Side& side) noexcept;
  Status close_in() noexcept;
  double apart(const Side& one, const Side& other) const noexcept;

  StageEquations& equations_;
  Side here_, there_, middle_;
  Unknowns mean_;  // of their steps; a alone
};

}  // namespace tress::integrators
