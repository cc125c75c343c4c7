#include "integrators/stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

// A matrix is rebuilt where more iterations than this are to come at the present rate.
// An exact tangent costs as much as six of them, and two follow it.
constexpr double most_to_come = 8;

}  // namespace

Stage::Stage(Dynamics& dynamics, const Options& options, Ending ending)
    : dynamics_(dynamics),
      contacts_(dynamics.system().contact_form()),
      stresses_(dynamics.system().stress_form()),
      contact_tolerance_(options.contact_tolerance),
      contact_iterations_(options.contact_iterations),
      rules_(NewtonRules::of(options.newton_tolerance, ending.remaining)),
      turned_(ending.turned),
      foresees_(contacts_ != nullptr && rules_.left < rules_.tolerance),
      iterations_(options.newton_iterations),
      refresh_(options.refresh),
      q_left_(static_cast<std::size_t>(dynamics.n())),
      q_corrected_(q_left_),
      q_(q_left_),
      v_(q_.size()),
      r_(q_.size()),
      c_(static_cast<std::size_t>(dynamics.m())),
      a_guess_(q_.size()),
      lambda_guess_(c_.size()),
      a_kept_(q_.size()),
      lambda_kept_(c_.size()),
      a_step_(q_.size()),
      lambda_step_(c_.size()),
      a_held_(q_.size()),
      lambda_held_(c_.size()),
      place_bar_(contacts_ == nullptr ? 0 : contacts_->tracked()),
      r_free_(q_.size()),
      q_next_(q_.size()),
      v_next_(q_.size()),
      q_start_(q_.size()),
      a_part_(q_.size()),
      lambda_part_(c_.size()),
      a_before_(q_.size()),
      here_(q_.size(), c_.size()),
      there_(q_.size(), c_.size()),
      middle_(q_.size(), c_.size()),
      path_(q_.size(), c_.size()),
      next_(q_.size(), c_.size()) {
  if (ending.learns) updates_.emplace(dynamics.q_typ());
}

void Stage::place(In q_bar, In v_bar, Weights w, In a) noexcept {
  for (std::size_t i = 0; i < q_.size(); ++i) {
    q_[i] = q_bar[i] + w.pos * a[i];
    v_[i] = v_bar[i] + w.vel * a[i];
  }
}

double Stage::size_of(In correction, Weights w) const noexcept {
  return std::max(w.pos * scaled_norm(correction, dynamics_.q_typ()),
                  w.vel * scaled_norm(correction, dynamics_.v_typ()));
}

Status Stage::correct(double t, In q_bar, In v_bar, Weights w, bool linearize, InOut a,
                      InOut lambda, double& correction) noexcept {
  if (linearize) {
    const Status s = dynamics_.linearize(t, q_, v_, a, lambda, w);
    if (s != Status::ok) return s;
    factored_ = w;
    matrix_ = dynamics_.matrix();
    if (updates_) updates_->forget();
  }
  Status s = dynamics_.residual(t, q_, v_, a, lambda, r_, c_);
  if (s != Status::ok) return s;
  s = dynamics_.solve(r_, c_);
  if (s != Status::ok) return s;
  ++dynamics_.stats.newton_iterations;
  if (updates_) updates_->improve(r_);
  if (stresses_ != nullptr) std::ranges::copy(q_, q_corrected_.begin());
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= r_[i];
  for (std::size_t k = 0; k < lambda.size(); ++k) lambda[k] -= c_[k];
  place(q_bar, v_bar, w, a);
  correction = size_of(r_, w);
  return std::isfinite(correction) ? Status::ok : Status::retry;
}

void Stage::leave(double t, In q) noexcept {
  if (stresses_ == nullptr) return;
  t_left_ = t;
  left_ = true;
  std::ranges::copy(q, q_left_.begin());
}

void Stage::take_stresses(double t, bool first) noexcept {
  if (stresses_ == nullptr || (first && !left_)) return;
  if (first) {
    stresses_->take_stresses(t_left_, q_left_, StressForm::Stresses::held);
  } else {
    stresses_->take_stresses(t, q_corrected_, StressForm::Stresses::followed);
  }
}

Status Stage::newton_step(double t, Weights w, In a, In lambda, Out a_step,
                          Out lambda_step, double& size) noexcept {
  Status s = dynamics_.linearize(t, q_, v_, a, lambda, w);
  if (s == Status::ok) {
    s = dynamics_.residual(t, q_, v_, a, lambda, a_step, lambda_step);
  }
  if (s == Status::ok) s = dynamics_.solve(a_step, lambda_step);
  if (s != Status::ok) return s;
  ++dynamics_.stats.newton_iterations;
  size = size_of(a_step, w);
  return std::isfinite(size) ? Status::ok : Status::retry;
}

Status Stage::solve_smooth(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                           Matrix matrix, Effort effort) noexcept {
  const Status s = by_newton(t, q_bar, v_bar, w, a, lambda, matrix);
  if (s != Status::retry || effort == Effort::plain) return s;
  return by_all_means(t, q_bar, v_bar, w, a, lambda);
}

Status Stage::by_newton(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                        Matrix matrix) noexcept {
  std::ranges::copy(a, a_guess_.begin());
  std::ranges::copy(lambda, lambda_guess_.begin());
  Status s = newton(t, q_bar, v_bar, w, refresh_, matrix, a, lambda);
  const auto newton_again = [&] {
    std::ranges::copy(a_guess_, a.begin());
    std::ranges::copy(lambda_guess_, lambda.begin());
    return newton(t, q_bar, v_bar, w, Refresh::every_iteration, Matrix::own, a, lambda);
  };
  if (s == Status::retry && refresh_ != Refresh::every_iteration) s = newton_again();
  if (s == Status::retry && stresses_ != nullptr) {
    // Those left may be far from the solution's too: a rope that is first pulled has
    // none.
    StressForm* const form = std::exchange(stresses_, nullptr);
    s = newton_again();
    stresses_ = form;
  }
  if (s == Status::retry) s = on_jump(t, q_bar, v_bar, w, a, lambda);
  if (s == Status::ok && left_) leave(t, q_);
  return s;
}

/// From the guess of by_newton(), from zero acceleration, from standstill.
Status Stage::by_all_means(double t, In q_bar, In v_bar, Weights w, InOut a,
                           InOut lambda) noexcept {
  Status s = Status::retry;
  for (int start = 0; s == Status::retry && start < 3; ++start) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = start == 0 ? a_guess_[i] : start == 1 ? 0 : -v_bar[i] / w.vel;
    }
    std::ranges::copy(lambda_guess_, lambda.begin());
    s = damped(t, q_bar, v_bar, w, a, lambda);
  }
  for (const Drift drift : {Drift::whole, Drift::own}) {
    if (s != Status::retry) break;
    std::ranges::copy(lambda_guess_, lambda.begin());
    s = lengthened(t, q_bar, v_bar, w, drift, a, lambda);
  }
  if (s == Status::ok && left_) leave(t, q_);
  return s;
}

Status Stage::newton(double t, In q_bar, In v_bar, Weights w, Refresh refresh,
                     Matrix matrix, InOut a, InOut lambda) noexcept {
  place(q_bar, v_bar, w, a);
  if (updates_) updates_->begin();
  double previous = std::numeric_limits<double>::infinity();
  double rate = rate_ = 0;
  int grown = 0;
  const bool usable =
      matrix_ == dynamics_.matrix() && factored_.vel == w.vel && factored_.pos == w.pos;
  if (matrix == Matrix::own) shares_ = true;
  const bool shared =
      refresh == Refresh::every_step && shares_ && matrix == Matrix::shared;
  bool linearize = !usable || !(refresh == Refresh::when_slow || shared);
  for (int i = 0; i < iterations_; ++i) {
    double correction = 0;
    if (linearize) take_stresses(t, i == 0);
    const bool foreseen = linearize && squared_ > 0;
    const Status s = correct(t, q_bar, v_bar, w, linearize, a, lambda, correction);
    if (s != Status::ok) return s;
    rate = rate_ = correction / previous;
    // The remaining error is the sum of the corrections to come: rate / (1 - rate) of
    // this one.
    double expected = rate;
    if (foreseen) {
      const double next = squared_ * correction;
      expected = i > 0 ? std::min(next, rate) : next;
    }
    const double error_left = expected > 0 && expected < 1
                                  ? NewtonRules::error_left(correction, expected)
                                  : correction;
    if (i > 0 && linearize && foresees_) {
      squared_ = std::max(i > 1 ? squared_ : 0.0, rate / previous);
    }
    if (correction <= rules_.tolerance) return Status::ok;
    const bool near = error_left <= rules_.left;
    if (near && contacts_ == nullptr) return Status::ok;
    if (rules_.stagnates(correction, rate, i)) return Status::ok;
    if (rate > 1 && i > 0 && ++grown == most_grown) return Status::retry;
    const bool slow = i > 0 && (rate >= 1 || std::log(rules_.left / correction) <
                                                 most_to_come * std::log(rate));
    linearize = !near && (refresh == Refresh::every_iteration || slow ||
                          ((i == 0 || linearize) && correction > turned_));
    if (slow) shares_ = false;
    previous = correction;
  }
  return Status::retry;
}

Status Stage::single_step(double t, In q_bar, In v_bar, Weights w, In a_matrix, InOut a,
                          InOut lambda) noexcept {
  place(q_bar, v_bar, w, a);
  const Status s = dynamics_.linearize(t, q_, v_, a_matrix, lambda, w);
  if (s != Status::ok) return s;
  double correction = 0;
  return correct(t, q_bar, v_bar, w, false, a, lambda, correction);
}

}  // namespace tress::integrators
