#include "integrators/stage/stage.h"

#include <algorithm>

namespace tress::integrators {
namespace {

// The first solution with contact is sought by Newton's method alone with so many
// penalties, then by all means with some of them again.
constexpr int penalties = 4, whole_attempts = 2;

}  // namespace

Stage::Stage(Dynamics& dynamics, const Options& options, Ending ending)
    : equations_(dynamics, NewtonRules::of(options.newton_tolerance, ending.remaining),
                 options.newton_iterations),
      stresses_(dynamics),
      contacts_(dynamics.system().contact_form()),
      watcher_(dynamic_cast<StageWatcher*>(&dynamics.system())),
      newton_(equations_, stresses_, options.refresh, ending, contacts_ != nullptr),
      jump_(equations_),
      damped_(equations_),
      continuation_(equations_, damped_),
      lengthened_(equations_, damped_, continuation_),
      x_(dynamics),
      guess_(x_),
      contact_tolerance_(options.contact_tolerance),
      contact_iterations_(options.contact_iterations),
      held_(x_) {
  if (contacts_ == nullptr) return;
  forces_.emplace(equations_, *contacts_, contact_tolerance_);
  q_start_.resize(x_.a.size());
  place_bar_.resize(contacts_->tracked());
}

void Stage::pose(double t, In q_bar, In v_bar, Weights w, In a, In lambda) noexcept {
  equations_.pose(t, q_bar, v_bar, w);
  std::ranges::copy(a, x_.a.begin());
  std::ranges::copy(lambda, x_.lambda.begin());
}

Status Stage::solve(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                    Matrix matrix, Effort effort) noexcept {
  pose(t, q_bar, v_bar, w, a, lambda);
  Status s = Status::retry;
  if (contacts_ != nullptr) {
    s = solve_with_contact(matrix, effort);
  } else {
    s = by_newton(matrix);
    if (s == Status::retry && effort == Effort::whole) s = by_all_means();
  }
  if (watcher_ != nullptr && s == Status::ok) {
    if (contacts_ != nullptr) {
      watcher_->prepared(w.pos / w.vel, q_start_, v_bar, place_bar_);
    }
    watcher_->solved(t, q(), v(), x_.a, x_.lambda);
  }
  std::ranges::copy(x_.a, a.begin());
  std::ranges::copy(x_.lambda, lambda.begin());
  return s;
}

Status Stage::single_step(double t, In q_bar, In v_bar, Weights w, In a_matrix, InOut a,
                          InOut lambda) noexcept {
  pose(t, q_bar, v_bar, w, a, lambda);
  const Status s = newton_.single_step(a_matrix, x_);
  std::ranges::copy(x_.a, a.begin());
  std::ranges::copy(x_.lambda, lambda.begin());
  return s;
}

/// A solution is where the next one goes on from.
Status Stage::noted(Status s) noexcept {
  if (s == Status::ok) stresses_.found(equations_.t(), equations_.q());
  return s;
}

Status Stage::by_newton(Matrix matrix) noexcept {
  guess_ = x_;
  Status s = newton_.solve(guess_, matrix, x_);
  if (s == Status::retry) s = jump_.solve(newton_.rate(), x_);
  return noted(s);
}

/// After by_newton() has failed.
Status Stage::by_all_means() noexcept {
  Status s = Status::retry;
  const In v_bar = equations_.v_bar();
  for (int start = 0; s == Status::retry && start < 3; ++start) {
    for (std::size_t i = 0; i < x_.a.size(); ++i) {
      x_.a[i] = start == 0   ? guess_.a[i]
                : start == 1 ? 0
                             : -v_bar[i] / equations_.w().vel;
    }
    x_.lambda = guess_.lambda;
    s = damped_.solve(x_);
  }
  using Drift = StageEquations::Drift;
  for (const Drift drift : {Drift::whole, Drift::own}) {
    if (s != Status::retry) break;
    x_.lambda = guess_.lambda;
    s = lengthened_.solve(drift, x_);
  }
  return noted(s);
}

Status Stage::with_forces(bool& touched) noexcept {
  return noted(forces_->solve(x_, touched));
}

Status Stage::solve_with_contact(Matrix matrix, Effort effort) noexcept {
  newton_.begin();
  Status s = first_contact(matrix, effort);
  if (s != Status::ok) return s;
  Dynamics& dynamics = equations_.dynamics;
  double violation = 0, drive = 0;
  for (int i = 1;; ++i) {
    violation = contacts_->improve(equations_.t(), q(), v());
    drive = contacts_->drive();
    ++dynamics.stats.contact_iterations;
    if (violation <= contact_tolerance_ || i == contact_iterations_) break;
    contacts_->extrapolate();
    s = next_contact();
    if (s == Status::ok) continue;
    if (s == Status::fatal) return s;
    x_ = held_;
    equations_.place(x_);
    break;
  }
  if (violation <= contact_tolerance_) return Status::ok;
  // Strands with more contacts than unknowns may stall above the tolerance, at what does
  // not matter in their motion. A law that is met within the tolerance bounds the drive
  // by it (ExactContact::State::violation()), and that bound is kept.
  if (drive > contact_tolerance_) {
    dynamics.driven = drive;
    return Status::retry;
  }
  ++dynamics.stats.contact_unfinished;
  double& worst = dynamics.stats.contact_violation;
  worst = std::max(worst, violation);
  return Status::ok;
}

/// The first solution, with multipliers of contact as they are at the start, and a
/// penalty of its own for every attempt. Where Newton's method fails with the first
/// penalty, state and forces are sought at once, from the guess and from zero
/// acceleration. If nothing is near, no penalty helps.
Status Stage::first_contact(Matrix matrix, Effort effort) noexcept {
  held_ = x_;
  const auto start_again = [&](double part) {
    for (std::size_t i = 0; i < x_.a.size(); ++i) x_.a[i] = part * held_.a[i];
    x_.lambda = held_.lambda;
  };
  const auto with_next_penalty = [&] {
    const Weights w = equations_.w();
    equations_.start(q_start_);
    contacts_->begin(equations_.t(), w.pos / w.vel, q_start_, equations_.v_bar(),
                     place_bar_);
    start_again(1);
    return by_newton(matrix);
  };
  Status s = with_next_penalty();
  bool touched = true;
  for (const double part : {1, 0}) {
    if (s != Status::retry || !touched) break;
    start_again(part);
    s = with_forces(touched);
  }
  for (int i = 1; s == Status::retry && touched && i < penalties; ++i) {
    s = with_next_penalty();
  }
  if (effort == Effort::plain) return s;
  for (int i = 0; s == Status::retry && i < (touched ? whole_attempts : 1); ++i) {
    if (touched) s = with_next_penalty();
    if (s == Status::retry) s = by_all_means();
  }
  return s;
}

/// Later solutions, likewise.
Status Stage::next_contact() noexcept {
  held_ = x_;
  Status s = by_newton(Matrix::own);
  if (s != Status::retry) return s;
  x_ = held_;
  bool touched = false;
  s = with_forces(touched);
  return s == Status::retry ? by_all_means() : s;
}

}  // namespace tress::integrators
