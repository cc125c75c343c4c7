#include "integrators/stage/continuation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tress::integrators {
namespace {

// Lengths are in typical coordinates and in parts of the step.
constexpr double first_length = 0.02, shortest_length = 1e-5, longest_length = 0.2;
constexpr int most_points = 100, most_corrections = 8;
constexpr double part_difference = 1e-7;  // forward, of a function of order one

}  // namespace

/// Scalar product of two changes of (a, part), as displacements at the step's end.
double Continuation::dot(const Unknowns& x, double part, const Unknowns& y,
                         double part_y) const noexcept {
  const Weights w = equations_.whole_w();
  return w.pos * w.pos * equations_.dot(x.a, y.a) + part * part_y;
}

/// The equations of this part of the step.
Status Continuation::evaluate(const Unknowns& x, double part, Unknowns& f) noexcept {
  equations_.take_part(part, StageEquations::Drift::own);
  equations_.place(x);
  return equations_.residual(x, f);
}

/// Prepares their matrix, f_ and f_part_: F and F(part + difference).
Status Continuation::linearize(const Point& at) noexcept {
  equations_.take_part(at.part, StageEquations::Drift::own);
  equations_.place(at.x);
  Status s = equations_.linearize(at.x);
  if (s == Status::ok) s = evaluate(at.x, at.part, f_);
  if (s == Status::ok) s = evaluate(at.x, at.part + part_difference, f_part_);
  return s;
}

/// Unit direction (a', part') with S a' = -F_part part', the way that `at` came from.
Status Continuation::find_direction(Point& at) noexcept {
  Status s = linearize(at);
  if (s != Status::ok) return s;
  Unknowns& slope = f_part_;
  slope.become(f_, -1, f_part_);
  s = equations_.solve(slope);
  if (s != Status::ok) return s;
  for (double& entry : slope.a) entry /= part_difference;
  for (double& entry : slope.lambda) entry /= part_difference;
  double size = std::sqrt(dot(slope, 1, slope, 1));
  if (!std::isfinite(size)) return Status::retry;
  if (dot(slope, 1, at.along, at.part_along) < 0) size = -size;
  const auto over_size = [&](double entry) { return entry / size; };
  std::ranges::transform(slope.a, at.along.a.begin(), over_size);
  std::ranges::transform(slope.lambda, at.along.lambda.begin(), over_size);
  at.part_along = 1 / size;
  return Status::ok;
}

/// From `from` along its direction, then back onto the path at right angles to it:
/// (to - guess).direction = 0, by elimination of the part.
Status Continuation::correct_onto(const Point& from, double length, Point& to) noexcept {
  const NewtonRules& rules = equations_.rules;
  to.x.become(from.x, length, from.along);
  to.part = from.part + length * from.part_along;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_corrections; ++i) {
    Status s = linearize(to);
    if (s != Status::ok) return s;
    f_part_.become(f_part_, -1, f_);
    s = equations_.solve(f_part_);  // S^-1 F_part part_difference
    if (s == Status::ok) s = equations_.solve(f_);
    if (s != Status::ok) return s;
    ++equations_.dynamics.stats.newton_iterations;
    // The guess lies on the plane already: only changes along it remain.
    const double by_part =
        from.part_along - dot(f_part_, 0, from.along, 0) / part_difference;
    const double change = dot(f_, 0, from.along, 0) / by_part;
    if (!std::isfinite(change)) return Status::retry;
    to.part += change;
    f_.become(f_, change / part_difference, f_part_);
    to.x.become(to.x, -1, f_);
    const double size =
        std::max(std::abs(change), equations_.size_of(f_, equations_.whole_w()));
    if (size <= rules.tolerance || (size <= rules.rounding && size > before / 2)) {
      return Status::ok;
    }
    if (!(size < before) && i > 1) return Status::retry;
    before = size;
  }
  return Status::retry;
}

Status Continuation::solve(double part, Unknowns& x) noexcept {
  double& reached = equations_.dynamics.reached;
  path_.x = x;
  std::ranges::fill(path_.along.a, 0.0);
  path_.part = part;
  path_.part_along = 1;
  reached = 0;
  double length = first_length, taken = 0;
  for (int k = 0; k < most_points; ++k) {
    const double slope = path_.part_along;
    Status s = find_direction(path_);
    if (s != Status::ok) return s;
    if (k > 0 && reached == 0 && path_.part_along < 0) {
      // Between the last point, at next_, and this one the slope falls through zero.
      reached = next_.part + taken * slope * slope / (2 * (slope - path_.part_along));
    }
    while ((s = correct_onto(path_, length, next_)) == Status::retry &&
           length > shortest_length) {
      length /= 2;
    }
    if (s != Status::ok) return s;
    if (next_.part <= 0) return Status::retry;
    if (next_.part >= 1) {
      x = next_.x;
      reached = 0;
      equations_.take_whole();
      return damped_.solve(x);
    }
    next_.along.a = path_.along.a;
    next_.part_along = path_.part_along;
    std::swap(path_, next_);
    taken = length;
    length = std::min(1.5 * length, longest_length);
  }
  return Status::retry;
}

}  // namespace tress::integrators
