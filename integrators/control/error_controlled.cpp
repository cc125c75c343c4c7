#include "integrators/control/error_controlled.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "contract/forms/contact_form.h"
#include "integrators/control/step_factors.h"
#include "linear/finite.h"

namespace tress::integrators {
namespace {

// A step this much shorter than one whose polynomial failed may have a good one: its
// error falls by 0.7^6 = 0.12.
constexpr double polynomial_factor = 0.7;
// The polynomial may stretch the strand twice as much as the ends of its step (4 times
// the strain energy), and by what a strand shows in rounding.
constexpr double more_stretch = 2, least_stretch = 1e-9;
// After so many steps without a solution, each a quarter of the one before, the first is
// tried with more effort, which cost 40 to 100 ordinary steps on hairs without friction.
constexpr int plain_steps = 3;

std::string text(double x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.9g", x);
  return digits;
}

}  // namespace

ErrorControlled::ErrorControlled(System& system, const Options& options, int power,
                                 double threshold)
    : options_(options),
      dynamics_(system, options),
      norm_(dynamics_),
      power_(power),
      threshold_(threshold),
      control_(power),
      q_(static_cast<std::size_t>(dynamics_.n())),
      v_(q_),
      begin_(q_.size(), static_cast<std::size_t>(dynamics_.m())),
      end_(begin_),
      error_q_(q_),
      error_v_(q_) {
  if (options.formulation == Formulation::projection) projection_.emplace(dynamics_);
}

Status ErrorControlled::end_run(Status status, const std::string& what) {
  failure_ = what + " at t = " + text(t_) + " s";
  return status == Status::ok ? Status::fatal : status;
}

Status ErrorControlled::fail(Status status, const std::string& what) {
  const Status s = end_run(status, what);
  failure_ += ", step " + std::to_string(dynamics_.stats.steps + 1);
  const std::string words = dynamics_.culprit(begin_.t, begin_.q, begin_.v);
  if (!words.empty()) failure_ += ": not finite: " + words;
  return s;
}

Status ErrorControlled::start(double t, In q, In v) {
  t_ = begin_.t = t;
  std::ranges::copy(q, q_.begin());
  std::ranges::copy(v, v_.begin());
  begin_.q = q_;
  begin_.v = v_;
  ahead_ = false;
  fails_from_ = std::numeric_limits<double>::infinity();
  failure_.clear();
  limit_ = Limit::none;
  dynamics_.begin();
  norm_.start(t, q);
  const double time = norm_.typical_time();
  control_.start(step_factors::first_part * time * std::pow(threshold_, 1 / power_),
                 std::max(options_.min_step, step_factors::shortest_part * time));
  const Status s = restart();
  return s == Status::ok ? s : fail(s, "no acceleration at the initial state");
}

Status ErrorControlled::restart() {
  stale_ = false;
  forget_steps();
  control_.forget();
  return dynamics_.accelerate(begin_.t, begin_.q, begin_.v, begin_.a, begin_.lambda);
}

void ErrorControlled::mark() { mark_ = {t_, q_, v_, control_, dynamics_.stats.steps}; }

void ErrorControlled::rewind() {
  t_ = begin_.t = mark_->t;
  q_ = begin_.q = mark_->q;
  v_ = begin_.v = mark_->v;
  control_ = mark_->control;
  dynamics_.stats.steps = mark_->steps;
  ahead_ = false;
  stale_ = true;
  failure_.clear();
  limit_ = Limit::none;
}

Status ErrorControlled::next_step(double t_end) {
  if (stale_) {
    const Status s = restart();
    if (s != Status::ok) return fail(s, "restart after an event failed");
  }
  // Every attempt starts from the contact forces at the step's start.
  ContactForm* contacts = dynamics_.system().contact_form();
  const std::vector<double> held =
      contacts == nullptr ? std::vector<double>{} : contacts->multipliers();
  const double longest =
      options_.max_step > 0 ? options_.max_step : std::numeric_limits<double>::infinity();
  Attempts attempts{.before = control_};
  // With contact Stage solves several times, and the effort is for all of them.
  if (contacts != nullptr) attempts.effort = Effort::whole;
  for (;;) {
    const double breaks = dynamics_.system().next_breakpoint(begin_.t);
    double stop = breaks;
    StepControl::Trial now = control_.next(stop - begin_.t, longest);
    if (now.h > polynomial_factor * fails_from_) {
      stop = std::min(breaks, t_end);
      now = control_.next(stop - begin_.t, longest);
    }
    end_.t = now.whole ? stop : begin_.t + now.h;
    if (contacts != nullptr) contacts->set_multipliers(held);
    const Status s = try_step(begin_, now.h, attempts.effort, end_, error_q_, error_v_);
    if (s == Status::fatal) return fail(s, "no solution for the step");
    if (s == Status::retry && attempts.effort == Effort::plain) {
      without_solution(now, attempts);
      continue;
    }
    if (s == Status::retry) {
      if (const Status r = unsolved(now); r != Status::ok) return r;
      continue;
    }
    const double error =
        norm_.of(end_.t, end_.q, end_.v, error_q_, error_v_) / threshold_;
    if (!(error <= 1)) {
      ++dynamics_.stats.rejected_by_error;
      control_.reject(now, error);
      const Status r = shortened("the error of the " + norm_.where());
      if (r != Status::ok) return r;
      continue;
    }
    if (projection_ && projection_->project(end_.t, end_.q, end_.v) != Status::ok) {
      if (const Status r = unsolved(now); r != Status::ok) return r;
      continue;
    }
    at_break_ = now.whole && stop == breaks;
    ahead_ = true;
    dynamics_.forget();
    control_.accept(now, error, begin_.t);
    Stats& done = dynamics_.stats;
    ++done.steps;
    done.smallest_step = control_.shortest().h;
    done.smallest_step_at = control_.shortest().at;
    done.smallest_step_cause = control_.shortest().cause;
    return Status::ok;
  }
}

void ErrorControlled::without_solution(const StepControl::Trial& failed,
                                       Attempts& attempts) {
  if (attempts.plain == 0) attempts.before = control_;
  ++dynamics_.stats.rejected_by_newton;
  ++dynamics_.stats.rejected;
  control_.unsolved(failed, "newton");
  if (++attempts.plain < plain_steps && !control_.too_short()) return;
  attempts.effort = Effort::whole;
  control_ = attempts.before;
}

Status ErrorControlled::unsolved(const StepControl::Trial& failed) {
  ++dynamics_.stats.rejected_by_newton;
  control_.unsolved(failed, "newton");
  return shortened("Newton's iteration does not converge");
}

Status ErrorControlled::shortened(const std::string& reason) {
  ++dynamics_.stats.rejected;
  if (!control_.too_short()) return Status::ok;
  return fail(Status::fatal, "tolerance " + text(options_.tolerance) +
                                 " needs a step below " + text(control_.least()) +
                                 " s, for " + reason);
}

void ErrorControlled::accept_end() {
  std::swap(begin_, end_);
  ahead_ = false;
  t_ = begin_.t;
  stale_ = dynamics_.system().accept(t_, begin_.q, begin_.v) || at_break_;
  q_ = begin_.q;
  v_ = begin_.v;
}

/// The quintic with the values, slopes and curvatures of both ends, and its slope.
void ErrorControlled::interpolate(double t) {
  const double h = end_.t - begin_.t;
  const double s = (t - begin_.t) / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
  const double from = 10 * s3 - 15 * s4 + 6 * s5, slope = 30 * (s2 - 2 * s3 + s4);
  const double value[] = {s - 6 * s3 + 8 * s4 - 3 * s5, (s2 - 3 * s3 + 3 * s4 - s5) / 2,
                          -4 * s3 + 7 * s4 - 3 * s5, (s3 - 2 * s4 + s5) / 2};
  const double rate[] = {1 - 18 * s2 + 32 * s3 - 15 * s4,
                         (2 * s - 9 * s2 + 12 * s3 - 5 * s4) / 2,
                         -12 * s2 + 28 * s3 - 15 * s4, (3 * s2 - 8 * s3 + 5 * s4) / 2};
  for (std::size_t i = 0; i < q_.size(); ++i) {
    const double rise = end_.q[i] - begin_.q[i];
    const double v0 = h * begin_.v[i], v1 = h * end_.v[i];
    const double a0 = h * h * begin_.a[i], a1 = h * h * end_.a[i];
    q_[i] = begin_.q[i] + from * rise + value[0] * v0 + value[1] * a0 + value[2] * v1 +
            value[3] * a1;
    v_[i] =
        (slope * rise + rate[0] * v0 + rate[1] * a0 + rate[2] * v1 + rate[3] * a1) / h;
  }
  t_ = t;
}

bool ErrorControlled::read(double t_end) {
  interpolate(t_end);
  if (projection_ && projection_->project(t_end, q_, v_) != Status::ok) return false;
  MaterialPoints* points = dynamics_.system().material_points();
  if (points == nullptr) return true;
  const auto stretch = [points](double t, In q) {
    return points->stretch(t, q).value_or(0);
  };
  const double ends = std::max(stretch(begin_.t, begin_.q), stretch(end_.t, end_.q));
  return stretch(t_end, q_) <= more_stretch * ends + least_stretch;
}

void ErrorControlled::give_back() {
  fails_from_ = end_.t - begin_.t;
  t_ = begin_.t;
  q_ = begin_.q;
  v_ = begin_.v;
  ahead_ = false;
  --dynamics_.stats.steps;
  ++dynamics_.stats.rejected;
}

Status ErrorControlled::advance(double t_end, const Observer& each_step) {
  const auto seen = [&] { return !each_step || each_step(t_, q_, v_); };
  for (long taken = 0; t_ < t_end;) {
    if (!ahead_) {
      if (taken++ >= options_.max_steps) {
        limit_ = Limit::steps;
        return fail(Status::fatal, "more than max_steps steps needed");
      }
      if (work_used_up(options_, dynamics_.stats, dynamics_.n())) {
        limit_ = Limit::work;
        return end_run(Status::fatal, "max_work used up");
      }
      if (const Status s = next_step(t_end); s != Status::ok) return s;
    }
    if (end_.t > t_end) {
      if (!read(t_end)) {
        give_back();
        continue;
      }
    } else {
      accept_end();
    }
    if (!seen()) return end_run(Status::fatal, "stopped");
  }
  return Status::ok;
}

}  // namespace tress::integrators
