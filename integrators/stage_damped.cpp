#include <algorithm>
#include <cmath>

#include "integrators/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

// A gradually lengthened step: its initial part, and the limits below which it fails.
constexpr double first_part = 0.1, shortest_part = 1e-3, least_growth = 1.05;

}  // namespace

Status Stage::damped(double t, In q_bar, In v_bar, Weights w, InOut a,
                     InOut lambda) noexcept {
  place(q_bar, v_bar, w, a);
  for (int i = 0; i < damped_patience * iterations_; ++i) {
    double size = 0;
    Status s = newton_step(t, w, a, lambda, a_step_, lambda_step_, size);
    if (s != Status::ok) return s;
    s = halve_until_smaller(t, q_bar, v_bar, w, size, a, lambda);
    const bool rounding = s == Status::retry && size <= rules_.rounding;
    if (size <= rules_.tolerance || rounding) return Status::ok;
    if (s != Status::ok) return s;
  }
  return Status::retry;
}

/// Takes the step a_step_, lambda_step_, or the largest halving of it for which the next
/// correction with the kept matrix is smaller than `size`, that of the step itself.
Status Stage::halve_until_smaller(double t, In q_bar, In v_bar, Weights w, double size,
                                  InOut a, InOut lambda) noexcept {
  std::ranges::copy(a, a_kept_.begin());
  std::ranges::copy(lambda, lambda_kept_.begin());
  for (double part = 1; part >= shortest_damped; part /= 2) {
    shifted(a, a_kept_, -part, a_step_);
    shifted(lambda, lambda_kept_, -part, lambda_step_);
    place(q_bar, v_bar, w, a);
    if (size <= rules_.tolerance) return Status::ok;
    Status s = dynamics_.residual(t, q_, v_, a, lambda, r_, c_);
    if (s == Status::ok) s = dynamics_.solve(r_, c_);
    if (s == Status::fatal) return s;
    if (s == Status::ok && shrinks_enough(size_of(r_, w), part, size)) return s;
  }
  return Status::retry;
}

/// The equations of a part of the step, s of its length, have v = v_bar + s w.vel a and
///     q = q_bar - left v_bar + s^2 w.pos a,
/// where `left` is 0 with the drift of the whole step, and (1 - s) w.pos/w.vel with the
/// part's own drift, so that the part starts where the whole step does.
Status Stage::lengthened(double t, In q_bar, In v_bar, Weights w, Drift drift, InOut a,
                         InOut lambda) noexcept {
  std::ranges::fill(a, 0.0);
  double before = 0, part = 0, growth = first_part;
  while (part < 1) {
    const double next = std::min(1.0, part == 0 ? growth : part * growth);
    std::ranges::copy(a, a_part_.begin());
    std::ranges::copy(lambda, lambda_part_.begin());
    double left = 0;
    if (drift == Drift::whole) {
      for (double& entry : a) entry *= (part / next) * (part / next);  // same position
    } else {
      left = (1 - next) * w.pos / w.vel;
      const double further = before > 0 ? (next - part) / (part - before) : 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        const double gained = part * a[i];
        a[i] = (gained + further * (gained - before * a_before_[i])) / next;
      }
    }
    shifted(q_start_, q_bar, -left, v_bar);
    const Status s = damped(t - left, q_start_, v_bar,
                            {w.acc, next * w.vel, next * next * w.pos}, a, lambda);
    if (s == Status::fatal) return s;
    if (s == Status::ok) {
      growth = part == 0 ? 2 : std::min(2.0, growth * growth);
      before = part;
      part = next;
      a_before_.swap(a_part_);
      continue;
    }
    std::ranges::copy(a_part_, a.begin());
    std::ranges::copy(lambda_part_, lambda.begin());
    growth = part == 0 ? growth / 4 : std::sqrt(growth);
    if (part == 0 && growth < shortest_part) return Status::retry;
    if (part > 0 && growth < least_growth) {
      return drift == Drift::own ? followed(t, q_bar, v_bar, w, part, a, lambda)
                                 : Status::retry;
    }
  }
  return Status::ok;
}

}  // namespace tress::integrators
