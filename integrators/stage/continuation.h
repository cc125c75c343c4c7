#pragma once

#include "integrators/stage/damped.h"

namespace tress::integrators {

/// Pseudo-arclength continuation [Keller 1977, in Applications of Bifurcation Theory,
/// 359] of the solution of a step in the part of it that is solved (with its own drift).
/// It passes the places where the solution turns back, at which Lengthened gets stuck. It
/// comes to the whole step, or Dynamics learns at which part the solution turned back
/// (`reached`), beyond which no solution continues the motion.
///
/// Cost: two matrices, four residuals and three solves or more for each of at most 100
/// points of the path. The most expensive way, and the last.
class Continuation {
 public:
  /// Works on `equations`, with `damped` for the first two points; both must outlive
  /// it.
  Continuation(StageEquations& equations, Damped& damped)
      : equations_(equations),
        damped_(damped),
        path_(equations.dynamics),
        next_(path_),
        f_(equations.dynamics),
        f_part_(f_) {}

  /// Continues from x, a solution of `part` of the step, to a solution of the whole step.
  Status solve(double part, Unknowns& x) noexcept;

 private:
  /// A point of the path of solutions, and its direction there.
  struct Point {
    explicit Point(const Dynamics& dynamics) : x(dynamics), along(dynamics) {}
    Unknowns x, along;
    double part = 0, part_along = 0;
  };
  Status find_direction(Point& at) noexcept;
  Status correct_onto(const Point& from, double length, Point& to) noexcept;
  Status linearize(const Point& at) noexcept;
  Status evaluate(const Unknowns& x, double part, Unknowns& f) noexcept;
  double dot(const Unknowns& x, double part, const Unknowns& y,
             double part_y) const noexcept;

  StageEquations& equations_;
  Damped& damped_;
  Point path_, next_;
  Unknowns f_, f_part_;  // the equations, and their change by a small part more
};

}  // namespace tress::integrators
