#include "integrators/stage/damped.h"

namespace tress::integrators {

Status Damped::solve(Unknowns& x) noexcept {
  const NewtonRules& rules = equations_.rules;
  equations_.place(x);
  for (int i = 0; i < damped_patience * equations_.iterations; ++i) {
    double size = 0;
    Status s = equations_.newton_correction(x, step_, size);
    if (s != Status::ok) return s;
    s = halve_until_smaller(size, x);
    const bool rounding = s == Status::retry && size <= rules.rounding;
    if (size <= rules.tolerance || rounding) return Status::ok;
    if (s != Status::ok) return s;
  }
  return Status::retry;
}

/// Takes step_, of this size, or the largest halving of it after which the next
/// correction with the kept matrix is smaller.
Status Damped::halve_until_smaller(double size, Unknowns& x) noexcept {
  start_ = x;
  for (double part = 1; part >= shortest_damped; part /= 2) {
    x.become(start_, -part, step_);
    equations_.place(x);
    if (size <= equations_.rules.tolerance) return Status::ok;
    const Status s = equations_.correction(x, next_);
    if (s == Status::fatal) return s;
    if (s == Status::ok && shrinks_enough(equations_.size_of(next_), part, size)) {
      return s;
    }
  }
  return Status::retry;
}

}  // namespace tress::integrators
