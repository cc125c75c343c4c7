#include "integrators/fixed_step.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tress::integrators {
namespace {

bool finite(In x) {
  return std::all_of(x.begin(), x.end(),
                     [](double entry) { return std::isfinite(entry); });
}

std::string no_solution(const Dynamics& dynamics, double h) {
  char text[160];
  if (dynamics.reached > 0) {
    std::snprintf(text, sizeof text,
                  "no solution for the step: it turns back at %.3g s, so a shorter step "
                  "is needed",
                  dynamics.reached * h);
  } else if (dynamics.driven > 0) {
    std::snprintf(text, sizeof text,
                  "no solution for the step: exact friction would drive a contact at "
                  "%.3g m/s; give a shorter step or more contact_iterations",
                  dynamics.driven);
  } else {
    return "no solution for the step";
  }
  return text;
}

}  // namespace

FixedStep::FixedStep(System& system, const Options& options)
    : options_(options),
      dynamics_(system, options),
      q_(static_cast<std::size_t>(dynamics_.n())),
      v_(q_.size()),
      a_(q_.size()),
      lambda_(static_cast<std::size_t>(dynamics_.m())) {
  if (options.formulation == Formulation::projection) projection_.emplace(dynamics_);
}

void FixedStep::take(In q, In v) {
  std::copy(q.begin(), q.end(), q_.begin());
  std::copy(v.begin(), v.end(), v_.begin());
}

Status FixedStep::start(double t, In q, In v) {
  take(q, v);
  std::ranges::fill(a_, 0.0);
  std::ranges::fill(lambda_, 0.0);
  t_ = t;
  failure_.clear();
  limit_ = Limit::none;
  dynamics_.begin();
  const Status s = reset(t);
  if (s == Status::ok) return s;
  const bool regular = dynamics_.system().traits().regular_mass;
  return fail(s, t,
              regular
                  ? "no acceleration at the initial state"
                  : "no acceleration at the initial state: the mass matrix is singular "
                    "there, which backward_euler and bdf2 allow");
}

Status FixedStep::end(Status status, double t, const std::string& what) {
  char time[32];
  std::snprintf(time, sizeof time, "%.9g", t);
  failure_ = what + " at t = " + time + " s";
  return status == Status::ok ? Status::fatal : status;
}

Status FixedStep::fail(Status status, double t, const std::string& what) {
  const Status s = end(status, t, what);
  failure_ += ", step " + std::to_string(dynamics_.stats.steps + 1);
  const std::string words = dynamics_.culprit(t, q_, v_);
  if (!words.empty()) failure_ += ": not finite: " + words;
  return s;
}

Status FixedStep::finish_step(double t) {
  if (!finite(q_) || !finite(v_)) return fail(Status::fatal, t, "state not finite");
  if (projection_) {
    const Status s = projection_->project(t, q_, v_);
    if (s != Status::ok) return fail(s, t, "projection onto the constraints failed");
  }
  if (dynamics_.system().accept(t, q_, v_)) {
    const Status s = go_on_changed(t);
    if (s != Status::ok) return fail(s, t, "restart after an event failed");
  }
  return Status::ok;
}

Status FixedStep::replace(In q, In v) {
  take(q, v);
  dynamics_.lose_matrix();
  return finish_step(t_);
}

Status FixedStep::advance(double t_end, const Observer& each_step) {
  const double t_begin = t_;
  const double span = t_end - t_begin;
  if (span <= 0) return Status::ok;
  // 1e-9: a span that is a whole number of steps up to rounding gets no extra step.
  const double count = std::max(1.0, std::ceil(span / options_.step - 1e-9));
  if (count > static_cast<double>(options_.max_steps)) {
    limit_ = Limit::steps;
    return fail(Status::fatal, t_, "more than max_steps steps needed");
  }
  const auto steps = static_cast<long>(count);
  const double h = span / count;
  for (long i = 0; i < steps; ++i) {
    const double t = t_begin + static_cast<double>(i) * h;
    if (const Status s = step(t, h); s != Status::ok) {
      return fail(s, t, no_solution(dynamics_, h));
    }
    t_ = i + 1 == steps ? t_end : t + h;
    if (const Status s = finish_step(t_); s != Status::ok) return s;
    ++dynamics_.stats.steps;
    dynamics_.forget();
    if (each_step && !each_step(t_, q_, v_)) return end(Status::fatal, t_, "stopped");
    if (t_ < t_end && work_used_up(options_, dynamics_.stats, dynamics_.n())) {
      limit_ = Limit::work;
      return end(Status::fatal, t_, "max_work used up");
    }
  }
  return Status::ok;
}

}  // namespace tress::integrators
