// Pseudo-arclength continuation of the solution of a step in the step's length.
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

// Lengths are in typical coordinates and in parts of the step.
constexpr double first_length = 0.02, shortest_length = 1e-5, longest_length = 0.2;
constexpr int most_points = 100, most_corrections = 8;
constexpr double part_difference = 1e-7;  // forward, of a function of order one

}  // namespace

/// Scalar product of two changes of (a, part), as displacements at the step's end.
double Stage::along(Weights w, In a, double part, In a_other,
                    double part_other) const noexcept {
  return w.pos * w.pos * scaled_dot(a, a_other) + part * part_other;
}

/// The equations of this part of the step (see lengthened(), Drift::own) at `at`.
Status Stage::equations(double t, In q_bar, In v_bar, Weights w, const OnPath& at,
                        double part, Out r, Out c) noexcept {
  const double left = (1 - part) * w.pos / w.vel;
  shifted(q_start_, q_bar, -left, v_bar);
  place(q_start_, v_bar, {w.acc, part * w.vel, part * part * w.pos}, at.a);
  return dynamics_.residual(t - left, q_, v_, at.a, at.lambda, r, c);
}

Status Stage::matrix_at(double t, In q_bar, In v_bar, Weights w,
                        const OnPath& at) noexcept {
  const double left = (1 - at.part) * w.pos / w.vel;
  const Weights of_part{w.acc, at.part * w.vel, at.part * at.part * w.pos};
  shifted(q_start_, q_bar, -left, v_bar);
  place(q_start_, v_bar, of_part, at.a);
  return dynamics_.linearize(t - left, q_, v_, at.a, at.lambda, of_part);
}

/// Unit direction (a', part') with S a' = -F_part part', the way that `at` came from.
Status Stage::direction(double t, In q_bar, In v_bar, Weights w, OnPath& at) noexcept {
  Status s = matrix_at(t, q_bar, v_bar, w, at);
  if (s == Status::ok) s = equations(t, q_bar, v_bar, w, at, at.part, r_, c_);
  const double further = at.part + part_difference;
  if (s == Status::ok) {
    s = equations(t, q_bar, v_bar, w, at, further, a_step_, lambda_step_);
  }
  if (s != Status::ok) return s;
  shifted(a_step_, r_, -1, a_step_);
  shifted(lambda_step_, c_, -1, lambda_step_);
  s = dynamics_.solve(a_step_, lambda_step_);
  if (s != Status::ok) return s;
  for (double& entry : a_step_) entry /= part_difference;
  for (double& entry : lambda_step_) entry /= part_difference;
  double size = std::sqrt(along(w, a_step_, 1, a_step_, 1));
  if (!std::isfinite(size)) return Status::retry;
  if (along(w, a_step_, 1, at.a_along, at.part_along) < 0) size = -size;
  std::ranges::transform(a_step_, at.a_along.begin(), [&](double x) { return x / size; });
  std::ranges::transform(lambda_step_, at.lambda_along.begin(),
                         [&](double x) { return x / size; });
  at.part_along = 1 / size;
  return Status::ok;
}

/// From `from` along its direction, then back onto the path at right angles to it:
/// (to - guess).direction = 0, by elimination of the part.
Status Stage::correct_onto(double t, In q_bar, In v_bar, Weights w, const OnPath& from,
                           double length, OnPath& to) noexcept {
  shifted(to.a, from.a, length, from.a_along);
  shifted(to.lambda, from.lambda, length, from.lambda_along);
  to.part = from.part + length * from.part_along;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_corrections; ++i) {
    Status s = matrix_at(t, q_bar, v_bar, w, to);
    if (s == Status::ok) s = equations(t, q_bar, v_bar, w, to, to.part, r_, c_);
    if (s == Status::ok) {
      s = equations(t, q_bar, v_bar, w, to, to.part + part_difference, a_step_,
                    lambda_step_);
    }
    if (s != Status::ok) return s;
    shifted(a_step_, a_step_, -1, r_);
    shifted(lambda_step_, lambda_step_, -1, c_);
    s = dynamics_.solve(a_step_, lambda_step_);  // S^-1 F_part part_difference
    if (s == Status::ok) s = dynamics_.solve(r_, c_);
    if (s != Status::ok) return s;
    ++dynamics_.stats.newton_iterations;
    // The guess lies on the plane already: only changes along it remain.
    const double by_part =
        from.part_along - along(w, a_step_, 0, from.a_along, 0) / part_difference;
    const double change = along(w, r_, 0, from.a_along, 0) / by_part;
    if (!std::isfinite(change)) return Status::retry;
    to.part += change;
    add(r_, change / part_difference, a_step_);
    add(c_, change / part_difference, lambda_step_);
    add(to.a, -1, r_);
    add(to.lambda, -1, c_);
    const double size = std::max(std::abs(change), size_of(r_, w));
    if (size <= rules_.tolerance || (size <= rules_.rounding && size > before / 2))
      return Status::ok;
    if (!(size < before) && i > 1) return Status::retry;
    before = size;
  }
  return Status::retry;
}

Status Stage::followed(double t, In q_bar, In v_bar, Weights w, double part, InOut a,
                       InOut lambda) noexcept {
  std::ranges::copy(a, path_.a.begin());
  std::ranges::copy(lambda, path_.lambda.begin());
  std::ranges::fill(path_.a_along, 0.0);
  path_.part = part;
  path_.part_along = 1;
  dynamics_.reached = 0;
  double length = first_length, taken = 0;
  for (int k = 0; k < most_points; ++k) {
    const double slope = path_.part_along;
    Status s = direction(t, q_bar, v_bar, w, path_);
    if (s != Status::ok) return s;
    if (k > 0 && dynamics_.reached == 0 && path_.part_along < 0) {
      // Between the last point, at next_, and this one the slope falls through zero.
      dynamics_.reached =
          next_.part + taken * slope * slope / (2 * (slope - path_.part_along));
    }
    while ((s = correct_onto(t, q_bar, v_bar, w, path_, length, next_)) ==
               Status::retry &&
           length > shortest_length) {
      length /= 2;
    }
    if (s != Status::ok) return s;
    if (next_.part <= 0) return Status::retry;
    if (next_.part >= 1) {
      std::ranges::copy(next_.a, a.begin());
      std::ranges::copy(next_.lambda, lambda.begin());
      dynamics_.reached = 0;
      return damped(t, q_bar, v_bar, w, a, lambda);
    }
    std::ranges::copy(path_.a_along, next_.a_along.begin());
    next_.part_along = path_.part_along;
    std::swap(path_, next_);
    taken = length;
    length = std::min(1.5 * length, longest_length);
  }
  return Status::retry;
}

}  // namespace tress::integrators
