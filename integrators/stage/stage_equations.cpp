#include "integrators/stage/stage_equations.h"

#include <algorithm>
#include <cmath>

namespace tress::integrators {

Status StageEquations::newton_correction(const Unknowns& x, Unknowns& step,
                                         double& size) noexcept {
  Status s = linearize(x);
  if (s == Status::ok) s = correction(x, step);
  if (s != Status::ok) return s;
  ++dynamics.stats.newton_iterations;
  size = size_of(step);
  return std::isfinite(size) ? Status::ok : Status::retry;
}

double StageEquations::size_of(const Unknowns& step, Weights w) const noexcept {
  return std::max(w.pos * scaled_norm(step.a, dynamics.q_typ()),
                  w.vel * scaled_norm(step.a, dynamics.v_typ()));
}

double StageEquations::dot(In x, In y) const noexcept {
  const In typ = dynamics.q_typ();
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i] / (typ[i] * typ[i]);
  return sum;
}

}  // namespace tress::integrators
