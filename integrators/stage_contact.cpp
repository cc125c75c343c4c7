#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

// The first solution with contact is sought by Newton's method alone with so many
// penalties, then by all means with some of them again.
constexpr int penalties = 4, whole_attempts = 2;

// Contacts are taken with the state up to so many velocities for every unknown: finding
// how they respond costs a residual for each.
constexpr double most_velocities = 2;
// An iteration with forces ends where corrections have grown by this, and where halving
// one so far does not help.
constexpr double most_growing = 2, least_part = 1e-3;
// What the forces of an iteration leave of the laws, over what contacts may leave.
constexpr double left = 0.01;

}  // namespace

Status Stage::solve(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                    Matrix matrix, Effort effort) noexcept {
  if (contacts_ == nullptr) {
    return solve_smooth(t, q_bar, v_bar, w, a, lambda, matrix, effort);
  }
  squared_ = 0;
  Status s = first_contact(t, q_bar, v_bar, w, a, lambda, matrix, effort);
  if (s != Status::ok) return s;
  double violation = 0, drive = 0;
  for (int i = 1;; ++i) {
    violation = contacts_->improve(t, q_, v_);
    drive = contacts_->drive();
    ++dynamics_.stats.contact_iterations;
    if (violation <= contact_tolerance_ || i == contact_iterations_) break;
    contacts_->extrapolate();
    s = next_contact(t, q_bar, v_bar, w, a, lambda);
    if (s == Status::ok) continue;
    if (s == Status::fatal) return s;
    std::ranges::copy(a_held_, a.begin());
    std::ranges::copy(lambda_held_, lambda.begin());
    place(q_bar, v_bar, w, a);
    break;
  }
  if (violation <= contact_tolerance_) return Status::ok;
  // Strands with more contacts than unknowns may stall above the tolerance, at what does
  // not matter in their motion. A law that is met within the tolerance bounds the drive
  // by it (ExactContact::State::violation()), and that bound is kept.
  if (drive > contact_tolerance_) {
    dynamics_.driven = drive;
    return Status::retry;
  }
  ++dynamics_.stats.contact_unfinished;
  double& worst = dynamics_.stats.contact_violation;
  worst = std::max(worst, violation);
  return Status::ok;
}

/// Where Newton's method fails with the first penalty, state and forces are sought at
/// once, from the guess and from zero acceleration. If nothing is near, no penalty helps.
Status Stage::first_contact(double t, In q_bar, In v_bar, Weights w, InOut a,
                            InOut lambda, Matrix matrix, Effort effort) noexcept {
  std::ranges::copy(a, a_held_.begin());
  std::ranges::copy(lambda, lambda_held_.begin());
  const auto start_again = [&](double part) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = part * a_held_[i];
    std::ranges::copy(lambda_held_, lambda.begin());
  };
  const auto with_next_penalty = [&] {
    const double tau = w.pos / w.vel;
    shifted(q_start_, q_bar, -tau, v_bar);
    contacts_->begin(t, tau, q_start_, v_bar, place_bar_);
    start_again(1);
    return by_newton(t, q_bar, v_bar, w, a, lambda, matrix);
  };
  Status s = with_next_penalty();
  bool touched = true;
  for (const double part : {1, 0}) {
    if (s != Status::retry || !touched) break;
    start_again(part);
    s = with_forces(t, q_bar, v_bar, w, a, lambda, touched);
  }
  for (int i = 1; s == Status::retry && touched && i < penalties; ++i) {
    s = with_next_penalty();
  }
  if (effort == Effort::plain) return s;
  for (int i = 0; s == Status::retry && i < (touched ? whole_attempts : 1); ++i) {
    if (touched) s = with_next_penalty();
    if (s == Status::retry) s = by_all_means(t, q_bar, v_bar, w, a, lambda);
  }
  return s;
}

/// Likewise.
Status Stage::next_contact(double t, In q_bar, In v_bar, Weights w, InOut a,
                           InOut lambda) noexcept {
  std::ranges::copy(a, a_held_.begin());
  std::ranges::copy(lambda, lambda_held_.begin());
  Status s = by_newton(t, q_bar, v_bar, w, a, lambda, Matrix::own);
  if (s != Status::retry) return s;
  std::ranges::copy(a_held_, a.begin());
  std::ranges::copy(lambda_held_, lambda.begin());
  bool touched = false;
  s = with_forces(t, q_bar, v_bar, w, a, lambda, touched);
  return s == Status::retry ? by_all_means(t, q_bar, v_bar, w, a, lambda) : s;
}

Status Stage::with_forces(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                          bool& touched) noexcept {
  Complementarity* const law = contacts_->complementarity();
  if (law == nullptr) return Status::retry;
  place(q_bar, v_bar, w, a);
  touched = law->take(t, q_, v_, q_, v_) > 0;
  const Status s = iterate_with_forces(t, q_bar, v_bar, w, a, lambda, touched);
  law->let_go(s == Status::ok);
  if (s == Status::ok && left_) leave(t, q_);
  return s;
}

Status Stage::iterate_with_forces(double t, In q_bar, In v_bar, Weights w, InOut a,
                                  InOut lambda, bool& touched) noexcept {
  Complementarity* const law = contacts_->complementarity();
  double first = 0, before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < iterations_; ++i) {
    double size = 0, violation = 0;
    Status s = newton_step(t, w, a, lambda, a_step_, lambda_step_, size);
    if (s != Status::ok) return s;
    shifted(q_next_, q_, -w.pos, a_step_);
    shifted(v_next_, v_, -w.vel, a_step_);
    const std::size_t count = 3 * law->take(t, q_, v_, q_next_, v_next_);
    touched = touched || count > 0;
    const bool too_many =
        static_cast<double>(count) > most_velocities * static_cast<double>(a.size());
    if (!touched || too_many) return Status::retry;
    s = find_compliance(t, w, a, lambda, count);
    if (s == Status::ok) {
      s = balanced_step(t, w, a, lambda, a_step_, lambda_step_, size, violation);
    }
    if (s != Status::ok) return s;
    if (i == 0) first = size;
    if (size > most_growing * first) return Status::retry;
    shifted(force_step_, force_kept_, -1, force_);
    std::ranges::copy(a, a_kept_.begin());
    std::ranges::copy(lambda, lambda_kept_.begin());
    const bool rounding = size <= rules_.rounding && size >= before / 2;
    if (size <= rules_.tolerance || rounding) {
      if (violation > contact_tolerance_) return Status::retry;
      go(q_bar, v_bar, w, 1, a, lambda);
      return Status::ok;
    }
    s = halve_with_forces(t, q_bar, v_bar, w, size, a, lambda);
    if (s != Status::ok) return s;
    before = size;
  }
  return Status::retry;
}

Status Stage::find_compliance(double t, Weights w, In a, In lambda,
                              std::size_t count) noexcept {
  Complementarity* const law = contacts_->complementarity();
  for (auto* entries : {&force_, &force_kept_, &force_step_, &velocity_, &change_}) {
    entries->assign(count, 0.0);
  }
  compliance_.resize(count * count);
  law->forces(force_kept_);
  law->set_forces(force_);
  Status s = dynamics_.residual(t, q_, v_, a, lambda, r_free_, c_);
  for (std::size_t k = 0; k < count && s == Status::ok; ++k) {
    force_[k] = 1;
    law->set_forces(force_);
    force_[k] = 0;
    s = dynamics_.residual(t, q_, v_, a, lambda, r_, c_);
    if (s != Status::ok) break;
    shifted(r_, r_free_, -1, r_);
    std::ranges::fill(c_, 0.0);
    s = dynamics_.solve(r_, c_);
    for (double& entry : r_) entry *= w.vel;
    law->responses(r_, Out(compliance_).subspan(count * k, count));
  }
  std::ranges::copy(force_kept_, force_.begin());
  law->set_forces(force_);
  return s;
}

Status Stage::balanced_step(double t, Weights w, In a, In lambda, Out a_step,
                            Out lambda_step, double& size, double& violation) noexcept {
  Complementarity* const law = contacts_->complementarity();
  const auto step = [&] {
    const Status s = dynamics_.residual(t, q_, v_, a, lambda, a_step, lambda_step);
    return s == Status::ok ? dynamics_.solve(a_step, lambda_step) : s;
  };
  Status s = step();
  if (s != Status::ok) return s;
  for (std::size_t i = 0; i < v_next_.size(); ++i) v_next_[i] = -w.vel * a_step[i];
  law->velocities(t, q_, v_, velocity_);
  law->responses(v_next_, change_);
  add(velocity_, 1, change_);
  violation = law->balance(compliance_, velocity_, left * contact_tolerance_, force_);
  law->set_forces(force_);
  s = step();
  if (s != Status::ok) return s;
  size = size_of(a_step, w);
  return std::isfinite(size) ? Status::ok : Status::retry;
}

void Stage::go(In q_bar, In v_bar, Weights w, double part, InOut a,
               InOut lambda) noexcept {
  shifted(a, a_kept_, -part, a_step_);
  shifted(lambda, lambda_kept_, -part, lambda_step_);
  shifted(force_, force_kept_, -part, force_step_);
  contacts_->complementarity()->set_forces(force_);
  place(q_bar, v_bar, w, a);
}

Status Stage::halve_with_forces(double t, In q_bar, In v_bar, Weights w, double size,
                                InOut a, InOut lambda) noexcept {
  for (double part = 1; part >= least_part; part /= 2) {
    go(q_bar, v_bar, w, part, a, lambda);
    double next = 0, violation = 0;
    const Status s = balanced_step(t, w, a, lambda, r_, c_, next, violation);
    if (s == Status::fatal) return s;
    if (s == Status::ok && shrinks_enough(next, part, size)) {
      go(q_bar, v_bar, w, part, a, lambda);
      return s;
    }
  }
  return Status::retry;
}

}  // namespace tress::integrators
