#include "integrators/error_controlled.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "linear/finite.h"

namespace tress::integrators {
namespace {

constexpr double safety = 0.9;
constexpr double least_factor = 0.2, most_factor = 5;
// A step within these factors of the one wanted is left alone.
constexpr double dead_from = 0.95, dead_to = 1.2;
// After a failed Newton iteration.
constexpr double newton_factor = 0.25, newton_ceiling = 0.5, ceiling_growth = 1.05;
// A step this much shorter than one whose polynomial failed may have a good one: its
// error falls by 0.7^6 = 0.12.
constexpr double polynomial_factor = 0.7;
// The polynomial may stretch the strand twice as much as the ends of its step (4 times
// the strain energy), and by what a strand shows in rounding.
constexpr double more_stretch = 2, least_stretch = 1e-9;
// First step over the time in which the body falls about its size, at tolerance 1: its
// estimate is far below any threshold for a motion that starts smoothly, and the control
// needs few trials otherwise.
constexpr double first_part = 0.1;
// Steps below this part of that time are lost in rounding.
constexpr double shortest_part = 1e-11;

constexpr std::string_view by_start = "start", by_error = "error", by_newton = "newton";

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
  ahead_ = rejected_ = false;
  ceiling_ = fails_from_ = std::numeric_limits<double>::infinity();
  failure_.clear();
  limit_ = Limit::none;
  dynamics_.begin();
  norm_.start(t, q);
  h_ = std::max(options_.min_step,
                first_part * norm_.typical_time() * std::pow(threshold_, 1 / power_));
  cause_ = by_start;
  const Status s = restart();
  return s == Status::ok ? s : fail(s, "no acceleration at the initial state");
}

Status ErrorControlled::restart() {
  before_ = 1;
  return dynamics_.accelerate(begin_.t, begin_.q, begin_.v, begin_.a, begin_.lambda);
}

ErrorControlled::Trial ErrorControlled::trial(double t_end) {
  double h = std::min(h_, ceiling_);
  if (options_.max_step > 0) h = std::min(h, options_.max_step);
  const double to_break = dynamics_.system().next_breakpoint(begin_.t) - begin_.t;
  const bool ends = h > polynomial_factor * fails_from_;
  const double left = ends ? std::min(to_break, t_end - begin_.t) : to_break;
  // 1e-9: no sliver is left by rounding.
  if (h > (1 - 1e-9) * left) return {left, left < h_, left == to_break};
  if (2 * h > left) h = left / 2;  // nor by a step that ends shortly before
  return {h, h < h_, false};
}

Status ErrorControlled::next_step(double t_end) {
  for (;;) {
    const Trial now = trial(t_end);
    end_.t = begin_.t + now.h;
    const Status s = try_step(begin_, now.h, end_, error_q_, error_v_);
    if (s == Status::fatal) return fail(s, "no solution for the step");
    if (s == Status::retry) {
      if (const Status r = unsolved(now.h); r != Status::ok) return r;
      continue;
    }
    const double error =
        norm_.of(end_.t, end_.q, end_.v, error_q_, error_v_) / threshold_;
    if (!(error <= 1)) {
      ++dynamics_.stats.rejected_by_error;
      const double factor = safety * std::pow(error, -1 / power_);
      if (const Status r =
              shorten(std::clamp(factor, least_factor, safety) * now.h, by_error);
          r != Status::ok) {
        return r;
      }
      continue;
    }
    if (projection_ && projection_->project(end_.t, end_.q, end_.v) != Status::ok) {
      if (const Status r = unsolved(now.h); r != Status::ok) return r;
      continue;
    }
    at_break_ = now.at_break;
    ahead_ = true;
    ++dynamics_.stats.steps;
    dynamics_.forget();
    Stats& done = dynamics_.stats;
    if (!now.cut && (done.smallest_step == 0 || now.h < done.smallest_step)) {
      done.smallest_step = now.h;
      done.smallest_step_at = begin_.t;
      done.smallest_step_cause = cause_;
    }
    adapt(now, error);
    return Status::ok;
  }
}

Status ErrorControlled::unsolved(double h) {
  ++dynamics_.stats.rejected_by_newton;
  ceiling_ = newton_ceiling * h;
  return shorten(newton_factor * h, by_newton);
}

Status ErrorControlled::shorten(double h, std::string_view cause) {
  ++dynamics_.stats.rejected;
  rejected_ = true;
  h_ = h;
  cause_ = cause;
  const double least = std::max(options_.min_step, shortest_part * norm_.typical_time());
  if (h >= least) return Status::ok;
  return fail(Status::fatal,
              "tolerance " + text(options_.tolerance) + " needs a step below " +
                  text(least) + " s" +
                  (cause == by_newton ? ", for Newton's iteration does not converge"
                                      : ", for the error of the " + norm_.where()));
}

void ErrorControlled::adapt(const Trial& taken, double error) {
  // 1e-4: an estimate of 0 does not decide about the step after the next.
  const double now = std::max(error, 1e-4);
  double factor = safety * std::pow(now, -0.7 / power_) * std::pow(before_, 0.4 / power_);
  factor = std::clamp(factor, least_factor, rejected_ ? 1 : most_factor);
  if (factor >= dead_from && factor <= dead_to) factor = 1;
  // A step that was cut says nothing against the length that the control had chosen.
  const double wanted = factor * taken.h;
  if (wanted < taken.h) cause_ = by_error;
  h_ = taken.cut ? std::max(h_, wanted) : wanted;
  h_ = std::max(h_, options_.min_step);  // unless that is rejected
  before_ = now;
  rejected_ = false;
  ceiling_ *= ceiling_growth;
}

Status ErrorControlled::accept_end() {
  std::swap(begin_, end_);
  ahead_ = false;
  t_ = begin_.t;
  const bool changed = dynamics_.system().accept(t_, begin_.q, begin_.v);
  q_ = begin_.q;
  v_ = begin_.v;
  if (!changed && !at_break_) return Status::ok;
  const Status s = restart();
  return s == Status::ok ? s : fail(s, "restart after an event failed");
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
    } else if (const Status s = accept_end(); s != Status::ok) {
      return s;
    }
    if (!seen()) return end_run(Status::fatal, "stopped");
  }
  return Status::ok;
}

}  // namespace tress::integrators
