#include "simulation/run/stepped_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contract/forms/contact_form.h"
#include "integrators/error_indicator.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {
namespace {

/// A step without a solution is divided into 2, 4 ... 2^halvings shorter ones.
constexpr int halvings = 6;
/// Per system: a run that needs more has too long a step, and its time is unbounded.
constexpr int most_shortened = 100;

/// Steps that fail are repeated as shorter ones; methods that choose their steps have
/// done that already.
bool has_fixed_step(const IntegratorEntry& method, const Options& options) {
  return !method.adaptive && options.tolerance == 0;
}

}  // namespace

void add_work(const Stats& from, Stats& to) {
  to.steps += from.steps;
  to.rejected += from.rejected;
  to.residuals += from.residuals;
  to.linearizations += from.linearizations;
  to.solves += from.solves;
  to.newton_iterations += from.newton_iterations;
  to.sweeps += from.sweeps;
  to.solver = from.solver;
  to.rank_deficiency = std::max(to.rank_deficiency, from.rank_deficiency);
  to.condition = std::max(to.condition, from.condition);
  to.rejected_by_error += from.rejected_by_error;
  to.rejected_by_newton += from.rejected_by_newton;
  to.replaced += from.replaced;
  to.contact_iterations += from.contact_iterations;
  to.contact_unfinished += from.contact_unfinished;
  to.contact_violation = std::max(to.contact_violation, from.contact_violation);
  if (from.smallest_step == 0) return;
  if (to.smallest_step != 0 && to.smallest_step <= from.smallest_step) return;
  to.smallest_step = from.smallest_step;
  to.smallest_step_at = from.smallest_step_at;
  to.smallest_step_cause = from.smallest_step_cause;
}

SteppedSystem::State SteppedSystem::initial_state() const {
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  State state{std::vector<double>(n), std::vector<double>(n), system->memory()};
  system->initial_state(state.q, state.v);
  return state;
}

void SteppedSystem::take_method(std::string_view method, const Options& options) {
  integrator =
      make_integrator(method, *system, options_beside_supports(*system, options));
}

void SteppedSystem::start(double begin, State state) {
  system->recall(state.memory);
  if (Teleports* const all = teleports(*system)) all->follow(begin);
  // Contact sets follow the state; if it was accepted before, nothing changes.
  system->accept(begin, state.q, state.v);
  status = integrator->start(begin, state.q, state.v);
  keep(begin, state.q, state.v);
  begun_ = q;
  before_ = {};
  failed_work_ = 0;
  indicator = 0;
  shortened_ = 0;
  gave_up_ = used_up_ = stays_ = false;
}

void SteppedSystem::advance(const IntegratorEntry& method, const Options& options,
                            double end, bool last) {
  Teleports* const all = teleports(*system);
  bool there = false;
  while (all != nullptr && status == Status::ok) {
    const double at = all->next_teleport(integrator->time());
    if (at > end) break;
    const double before = models::just_before(at);
    if (before > integrator->time()) {
      advance_between_teleports(method, options, before, false);
    }
    if (status == Status::ok) teleport(method, options, *all, at, end);
    there = integrator->time() == end;
  }
  if (!there) advance_between_teleports(method, options, end, last);
}

/// The forces of exact contacts are found again, from none: bodies need not have jumped.
void SteppedSystem::teleport(const IntegratorEntry& method, const Options& options,
                             Teleports& all, double at, double end) {
  keep(integrator->time(), integrator->q(), integrator->v());
  if (guard && !guard->judge(t, q, v)) {
    status = Status::fatal;
    return;
  }
  all.teleport(at, q, v);
  if (ContactForm* const contacts = system->contact_form()) {
    contacts->set_multipliers(std::vector<double>(contacts->multipliers().size()));
  }
  system->accept(at, q, v);
  if (guard) guard->teleported(at, q, v);
  restart(method, options, after_teleport(at, end));
  keep(integrator->time(), integrator->q(), integrator->v());
  begun_ = q;
}

void SteppedSystem::advance_between_teleports(const IntegratorEntry& method,
                                              const Options& options, double end,
                                              bool last) {
  if (status != Status::ok) return;
  const double begin = integrator->time(), span = end - begin,
               count = parts * std::max(1.0, std::ceil(span / options.step - 1e-9));
  const bool again =
      has_fixed_step(method, options) && count <= static_cast<double>(options.max_steps);
  keep(begin, integrator->q(), integrator->v());
  begun_ = q;
  status = take_steps(end, span / count);
  while (again && status != Status::ok && !breached() && !gave_up_ &&
         work_left(options) > 0 && shortened_++ < most_shortened) {
    const double next = t + span / count;
    status =
        shorter_steps(method, options, next < end - 1e-6 * span / count ? next : end);
    if (status == Status::ok) status = take_steps(end, span / count);
  }
  if (!guard || breached() || (status == Status::ok && !last)) return;
  if (!guard->judge(t, q, v)) status = Status::fatal;
}

/// Advances to `end`, by steps of h where the method's own are divided into parts.
Status SteppedSystem::take_steps(double end, double h) {
  if (parts == 1) return integrator->advance(end, observer());
  Status s = Status::ok;
  while (s == Status::ok && integrator->time() < end) {
    const double next = integrator->time() + h;
    s = integrator->advance(next < end - 1e-6 * h ? next : end, observer());
  }
  return s;
}

std::string SteppedSystem::no_dissipation() const {
  if (!guard) return "without a guard no account is kept: leave out guard = false";
  if (system->energetics() == nullptr) return "the model computes no energy";
  if (system->contact_form() != nullptr) {
    return "impulses of exact contact change the energy by no power";
  }
  return {};
}

/// Of Options::max_work, which bounds failed attempts too.
double SteppedSystem::work_left(const Options& options) const {
  if (options.max_work == 0) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<int>(q.size());
  return options.max_work - failed_work_ - total_work(stats(), n);
}

/// From the last successful state to `end`, one step further, with as few shorter steps
/// as needed; from there the method continues with its own step.
Status SteppedSystem::shorter_steps(const IntegratorEntry& method, const Options& options,
                                    double end) {
  const double begin = t;
  const std::vector<double> old_q = q, old_v = v, memory = system->memory();
  const auto gathered = guard ? guard->memory() : Guards::Memory{};
  Options shorter = options_beside_supports(*system, options);
  for (int k = 0; k < halvings && work_left(options) > 0; ++k) {
    ++before_.rejected;
    if (options.max_work > 0) shorter.max_work = work_left(options);
    shorter.step = (end - begin) / std::ldexp(2.0, k);
    const auto steps = make_integrator(method.id, *system, shorter);
    keep(begin, old_q, old_v);
    system->recall(memory);
    system->accept(begin, q, v);
    if (guard) guard->recall(gathered, begin, q);
    Status now = steps->start(begin, q, v);
    if (now == Status::ok) now = steps->advance(end, observer());
    if (breached()) return Status::fatal;
    if (now != Status::ok) {
      failed_work_ += total_work(steps->stats(), static_cast<int>(q.size()));
      continue;
    }
    add_work(steps->stats(), before_);
    indicator = std::max(indicator, indicator_of(*steps));
    restart(method, options, end);
    return status;
  }
  used_up_ = work_left(options) <= 0;
  gave_up_ = !used_up_;
  return Status::fatal;
}

void SteppedSystem::restart(const IntegratorEntry& method, const Options& options,
                            double at) {
  add_work(integrator->stats(), before_);
  indicator = std::max(indicator, indicator_of(*integrator));
  if (options.max_work > 0) {
    Options rest = options;
    rest.max_work = std::max(work_left(options), std::numeric_limits<double>::min());
    take_method(method.id, rest);
  }
  status = integrator->start(at, q, v);
}

void SteppedSystem::stay(In at) {
  q.assign(at.begin(), at.end());
  v.assign(q.size(), 0.0);
  status = Status::fatal;
  stays_ = true;
}

void SteppedSystem::keep(double at, In new_q, In new_v) {
  t = at;
  q.assign(new_q.begin(), new_q.end());
  v.assign(new_v.begin(), new_v.end());
}

Observer SteppedSystem::observer() {
  return [this](double at, In new_q, In new_v) {
    if (depth) depth->look(*system->material_points(), t, q, at, new_q);
    keep(at, new_q, new_v);
    return !guard || (*guard)(at, new_q, new_v);
  };
}

std::string SteppedSystem::failure() const {
  if (breached()) return guard->breach()->message();
  return integrator->failure() +
         (gave_up_ ? fmt::format(", nor for {:g} in its place", std::ldexp(1.0, halvings))
          : used_up_ ? "; max_work used up by shorter steps"
                     : "");
}

Limit SteppedSystem::limit() const {
  return used_up_ ? Limit::work : integrator->limit();
}

Stats SteppedSystem::stats() const {
  Stats sum = before_;
  add_work(integrator->stats(), sum);
  return sum;
}

}  // namespace tress::simulation
