#include "integrators/sundials/driver.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "contract/input_error.h"

namespace tress::integrators {
namespace {

// An interval this short (relative to the time itself) is below the resolution of time;
// SUNDIALS rejects it.
constexpr double shortest_stretch = 100 * std::numeric_limits<double>::epsilon();

// A failing integrator continues with ever smaller steps instead of stopping: after this
// many consecutive steps below the resolution of time it counts as stuck.
constexpr double time_resolution = 4 * std::numeric_limits<double>::epsilon();
constexpr int most_lost_steps = 100;

std::string text(double x) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr;
  return {digits.data(), end};
}

}  // namespace

Driver::Driver(std::string_view id, System& system, const Options& options,
               std::span<const Formulation> formulations, int unknowns)
    : options_(options),
      y_(context_, 2 * system.layout().coordinates + unknowns),
      atol_(context_, 2 * system.layout().coordinates + unknowns),
      id_(id),
      system_(system),
      n_(static_cast<std::size_t>(system.layout().coordinates)) {
  if (std::ranges::find(formulations, options.formulation) == formulations.end()) {
    throw InputError(id_ + " cannot solve this formulation of constraints",
                     std::string(name(options.formulation)),
                     options.formulation == Formulation::projection
                         ? "SUNDIALS projects in cvode_bdf only; ida has index2_ggl"
                         : "choose one that --list shows for it");
  }
  const Out y = y_.values();
  system.initial_state(y.first(n_), y.subspan(n_, n_));
  const Out atol = atol_.values();
  system.scale(atol.first(n_), atol.subspan(n_, n_));
  for (double& entry : atol.first(2 * n_)) entry *= options.atol;
  last_.resize(y.size());
}

Status Driver::start(double t, In q, In v) {
  time_ = t;
  std::copy(q.begin(), q.end(), y_.values().begin());
  std::copy(v.begin(), v.end(), y_.values().begin() + static_cast<std::ptrdiff_t>(n_));
  failure_.clear();
  limit_ = Limit::none;
  dynamics().forget();
  steps_ = 0;
  carried_ = {};
  work_before_ = work();
  return begin();
}

Status Driver::begin() {
  context_.messages.clear();
  restarted_ = true;
  const int code = restart();
  return code < 0 ? fail_with(code) : Status::ok;
}

Status Driver::advance(double t_end, const Observer& each_step) {
  if (!failure_.empty()) return Status::fatal;
  if (t_end < time_) return fail("the end " + text(t_end) + " s lies in the past");
  const In positions = q(), velocities = v();
  int lost = 0;
  for (long taken = 0; time_ < t_end; ++taken) {
    if (t_end - time_ <= shortest_stretch * std::max(std::abs(t_end), std::abs(time_))) {
      time_ = t_end;
      return Status::ok;
    }
    if (taken >= options_.max_steps) {
      limit_ = Limit::steps;
      return fail("max_steps = " + std::to_string(options_.max_steps) +
                  " used up before " + text(t_end) + " s");
    }
    if (work_used_up(options_, stats(), dynamics().n())) {
      limit_ = Limit::work;
      return fail("max_work used up");
    }
    std::ranges::copy(y_.values(), last_.begin());
    double reached = time_;
    const int code = step(t_end, reached);
    if (code < 0) {  // y_ may hold a trial state
      std::ranges::copy(last_, y_.values().begin());
      const Stats counted = added_counters();
      if (!recover(code)) return fail_with(code);
      carried_ = counted;
      ++carried_.rejected;
      restarted_ = true;
      continue;
    }
    const double length = reached - time_;
    time_ = reached;
    ++steps_;
    restarted_ = false;
    lost = length > time_resolution * std::abs(time_) ? 0 : lost + 1;
    if (lost == 0) dynamics().forget();
    if (lost > most_lost_steps) {
      return fail_in_step("stuck: steps below the resolution of time");
    }
    const Out y = y_.values();
    if (system_.accept(time_, y.first(n_), y.subspan(n_, n_))) {
      carried_ = added_counters();
      if (const Status s = begin(); s != Status::ok) return s;
    }
    if (each_step && !each_step(time_, positions, velocities)) {
      return fail("stopped by the observer");
    }
  }
  return Status::ok;
}

Status Driver::fail(const std::string& why) {
  failure_ = id_ + " at t = " + text(time_) + " s: " + why;
  return Status::fatal;
}

Status Driver::fail_in_step(std::string why) {
  const std::string words = dynamics().culprit(time_, q(), v());
  if (!words.empty()) {
    why += ", step " + std::to_string(steps_ + 1) + ": not finite: " + words;
  }
  return fail(why);
}

Status Driver::fail_with(int code) {
  std::string why = reason(code);
  const std::string said = context_.messages.last();
  if (!said.empty()) why += " (" + said + ")";
  std::ranges::replace(why, '\n', ' ');
  return fail_in_step(std::move(why));
}

Stats Driver::added_counters() const {
  Stats sum = restarted_ ? Stats{} : counters();
  sum.rejected += carried_.rejected;
  sum.newton_iterations += carried_.newton_iterations;
  return sum;
}

Stats Driver::stats() const {
  const Stats counted = added_counters();
  Stats all = work();
  all.residuals -= work_before_.residuals;
  all.linearizations -= work_before_.linearizations;
  all.solves -= work_before_.solves;
  all.steps = steps_;
  all.rejected = counted.rejected;
  all.newton_iterations += counted.newton_iterations - work_before_.newton_iterations;
  return all;
}

int chosen_order(std::string_view id, const Options& options, int standard, int least,
                 int most) {
  if (options.max_order == 0) return standard;
  if (options.max_order < least || options.max_order > most) {
    throw InputError("order " + std::to_string(options.max_order) + " out of range",
                     std::string(id) + " max_order",
                     "choose " + std::to_string(least) + " to " + std::to_string(most));
  }
  return options.max_order;
}

}  // namespace tress::integrators
