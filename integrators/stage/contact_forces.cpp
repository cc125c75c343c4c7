#include "integrators/stage/contact_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::integrators {
namespace {

// Contacts are taken with the state up to so many velocities for every unknown: finding
// how they respond costs a residual for each.
constexpr double most_velocities = 2;
// An iteration with forces ends where corrections have grown by this, and where halving
// one so far does not help.
constexpr double most_growing = 2, least_part = 1e-3;
// What the forces of an iteration leave of the laws, over what contacts may leave.
constexpr double left = 0.01;

}  // namespace

Status ContactForces::solve(Unknowns& x, bool& touched) noexcept {
  Complementarity* const law = contacts_.complementarity();
  if (law == nullptr) return Status::retry;
  equations_.place(x);
  const In q = equations_.q(), v = equations_.v();
  touched = law->take(equations_.t(), q, v, q, v) > 0;
  const Status s = iterate(*law, x, touched);
  law->let_go(s == Status::ok);
  return s;
}

Status ContactForces::iterate(Complementarity& law, Unknowns& x, bool& touched) noexcept {
  const NewtonRules& rules = equations_.rules;
  const Weights w = equations_.w();
  const In q = equations_.q(), v = equations_.v();
  double first = 0, before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < equations_.iterations; ++i) {
    double size = 0, violation = 0;
    Status s = equations_.newton_correction(x, step_, size);
    if (s != Status::ok) return s;
    shifted(q_next_, q, -w.pos, step_.a);
    shifted(v_next_, v, -w.vel, step_.a);
    const std::size_t count = 3 * law.take(equations_.t(), q, v, q_next_, v_next_);
    touched = touched || count > 0;
    const bool too_many =
        static_cast<double>(count) > most_velocities * static_cast<double>(x.a.size());
    if (!touched || too_many) return Status::retry;
    s = find_compliance(law, x, count);
    if (s == Status::ok) s = balance(law, x, step_, size, violation);
    if (s != Status::ok) return s;
    if (i == 0) first = size;
    if (size > most_growing * first) return Status::retry;
    shifted(force_step_, force_start_, -1, force_);
    start_ = x;
    const bool rounding = size <= rules.rounding && size >= before / 2;
    if (size <= rules.tolerance || rounding) {
      if (violation > tolerance_) return Status::retry;
      go(law, 1, x);
      return Status::ok;
    }
    s = halve_until_smaller(law, size, x);
    if (s != Status::ok) return s;
    before = size;
  }
  return Status::retry;
}

/// How the contacts' velocities respond to forces, by the matrix of now.
Status ContactForces::find_compliance(Complementarity& law, const Unknowns& x,
                                      std::size_t count) noexcept {
  for (auto* entries : {&force_, &force_start_, &force_step_, &velocity_, &change_}) {
    entries->assign(count, 0.0);
  }
  compliance_.resize(count * count);
  law.forces(force_start_);
  law.set_forces(force_);
  std::vector<double>& response = response_.a;
  Status s = equations_.residual(x, free_);
  for (std::size_t k = 0; k < count && s == Status::ok; ++k) {
    force_[k] = 1;
    law.set_forces(force_);
    force_[k] = 0;
    s = equations_.residual(x, response_);
    if (s != Status::ok) break;
    shifted(response, free_.a, -1, response);
    std::ranges::fill(response_.lambda, 0.0);
    s = equations_.solve(response_);
    for (double& entry : response) entry *= equations_.w().vel;
    law.responses(response, Out(compliance_).subspan(count * k, count));
  }
  force_ = force_start_;
  law.set_forces(force_);
  return s;
}

/// From x and the forces of now to those with which the step obeys the laws, up to
/// `violation` (m/s).
Status ContactForces::balance(Complementarity& law, const Unknowns& x, Unknowns& step,
                              double& size, double& violation) noexcept {
  Status s = equations_.correction(x, step);
  if (s != Status::ok) return s;
  const double vel = equations_.w().vel;
  for (std::size_t i = 0; i < v_next_.size(); ++i) v_next_[i] = -vel * step.a[i];
  law.velocities(equations_.t(), equations_.q(), equations_.v(), velocity_);
  law.responses(v_next_, change_);
  add(velocity_, 1, change_);
  violation = law.balance(compliance_, velocity_, left * tolerance_, force_);
  law.set_forces(force_);
  s = equations_.correction(x, step);
  if (s != Status::ok) return s;
  size = equations_.size_of(step);
  return std::isfinite(size) ? Status::ok : Status::retry;
}

void ContactForces::go(Complementarity& law, double part, Unknowns& x) noexcept {
  x.become(start_, -part, step_);
  shifted(force_, force_start_, -part, force_step_);
  law.set_forces(force_);
  equations_.place(x);
}

/// Takes step_ and that of the forces, or the largest halving of both after which the
/// next one, by the same matrix, is smaller.
Status ContactForces::halve_until_smaller(Complementarity& law, double size,
                                          Unknowns& x) noexcept {
  for (double part = 1; part >= least_part; part /= 2) {
    go(law, part, x);
    double next = 0, violation = 0;
    const Status s = balance(law, x, next_, next, violation);
    if (s == Status::fatal) return s;
    if (s == Status::ok && shrinks_enough(next, part, size)) {
      go(law, part, x);
      return s;
    }
  }
  return Status::retry;
}

}  // namespace tress::integrators
