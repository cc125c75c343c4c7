// Advances a World: strands in parallel, every step checked by their guards, and steps
// without a solution repeated as shorter ones.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contract/moving_history.h"
#include "integrators/catalogue.h"
#include "integrators/error_indicator.h"
#include "simulation/run/world.h"

namespace tress::simulation {
namespace {

/// A step without a solution is divided into 2, 4 ... 2^halvings shorter ones.
constexpr int halvings = 6;
/// Per strand: a run that needs more has too long a step, and its time is unbounded.
constexpr int most_shortened = 100;

/// Steps that fail are repeated as shorter ones; methods that choose their steps have
/// done that already.
bool has_fixed_step(const IntegratorEntry& integrator, const Options& options) {
  return !integrator.adaptive && options.tolerance == 0;
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
  to.contact_iterations += from.contact_iterations;
  to.contact_unfinished += from.contact_unfinished;
  to.contact_violation = std::max(to.contact_violation, from.contact_violation);
  if (from.smallest_step == 0) return;
  if (to.smallest_step != 0 && to.smallest_step <= from.smallest_step) return;
  to.smallest_step = from.smallest_step;
  to.smallest_step_at = from.smallest_step_at;
  to.smallest_step_cause = from.smallest_step_cause;
}

void add_exchanges(const Exchanges& from, Exchanges& to) {
  to.accepted += from.accepted;
  to.rejected += from.rejected;
  if (from.shortest.h == 0) return;
  if (to.shortest.h == 0 || from.shortest.h < to.shortest.h) to.shortest = from.shortest;
}

Status World::advance(double t_end) {
  if (control_) return advance_controlled(t_end);
  // Without an exchange no strand has to wait for the others.
  const double span = t_end - t_;
  const bool exchanges = interaction_ || rubbing_ || mesh_;
  const double count =
      exchanges ? std::max(1.0, std::ceil(span / options_.step - 1e-9)) : 1.0;
  const double begin = t_;
  for (long i = 1; i <= static_cast<long>(count); ++i) {
    const double t = i == static_cast<long>(count)
                         ? t_end
                         : begin + static_cast<double>(i) * (span / count);
    const bool last = i == static_cast<long>(count);
    const double h = t - t_;
    if (rubbing_) rubbing_->before_step(positions(), loop());
    x_.forget();
    u_.forget();
    crew_.run(bodies_.size(), [&](std::size_t k) {
      advance(bodies_[k], t, last);
      // What an exchange asks for costs least while the strand is near in memory.
      if (!exchanges || bodies_[k].status != Status::ok) return;
      read_positions(k, t);
      read_velocities(k, t);
      if (rubbing_) rubbing_->prepare(k, h);
    });
    t_ = t;
    for (const Body& body : bodies_) {
      if (body.status == Status::ok) continue;
      failure_ = failure_of(body);
      return body.status;
    }
    if (rubbing_) {
      if (const Status s = rub(h); s != Status::ok) return s;
    }
    exchange();
  }
  return Status::ok;
}

Status World::rub(double h) {
  const Status done = rubbing_->after_step(t_, h, positions(), velocities(), loop());
  std::size_t body = 0;
  for (const std::size_t k : rubbing_->friction().touching()) {
    while (k >= bodies_[body].first + bodies_[body].coordinates.size()) ++body;
    x_.done[body] = u_.done[body] = 0;
  }
  crew_.run(bodies_.size(), [&](std::size_t k) {
    if (x_.done[k] != 0) return;
    Body& touched = bodies_[k];
    touched.keep(t_, touched.integrator->q(), touched.integrator->v());
  });
  if (done != Status::ok) failure_ = rubbing_->failure();
  return done;
}

/// The guard always checks the last state, even if the method failed there.
void World::advance(Body& body, double t, bool last) {
  if (body.status != Status::ok) return;
  const double span = t - t_,
               count = std::max(1.0, std::ceil(span / options_.step - 1e-9));
  const bool again = has_fixed_step(integrator_, options_) &&
                     count <= static_cast<double>(options_.max_steps);
  Integrator& method = *body.integrator;
  body.keep(t_, method.q(), method.v());
  body.status = method.advance(t, body.observer());
  while (again && body.status != Status::ok && !body.breached() && !body.gave_up &&
         work_left(body) > 0 && body.shortened++ < most_shortened) {
    const double end = body.t + span / count;
    body.status = shorter_steps(body, end < t - 1e-6 * span / count ? end : t);
    if (body.status == Status::ok) body.status = method.advance(t, body.observer());
  }
  if (!body.guard || body.breached() || (body.status == Status::ok && !last)) return;
  if (!body.guard->judge(body.t, body.q, body.v)) body.status = Status::fatal;
}

/// Of Options::max_work, which bounds failed attempts too.
double World::work_left(const Body& body) const {
  if (options_.max_work == 0) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<int>(body.q.size());
  return options_.max_work - body.failed_work - total_work(body.stats(), n);
}

/// From the last successful state to `end`, one step further, with as few shorter steps
/// as needed; from there the method continues with its own step.
Status World::shorter_steps(Body& body, double end) {
  const double begin = body.t;
  const std::vector<double> q = body.q, v = body.v, memory = body.system->memory();
  const auto gathered = body.guard ? body.guard->memory() : Guard::Memory{};
  Options shorter = options_;
  for (int k = 0; k < halvings && work_left(body) > 0; ++k) {
    ++body.before.rejected;
    if (options_.max_work > 0) shorter.max_work = work_left(body);
    shorter.step = (end - begin) / std::ldexp(2.0, k);
    const auto method = make_integrator(integrator_.id, *body.system, shorter);
    body.keep(begin, q, v);
    body.system->recall(memory);
    body.system->accept(begin, body.q, body.v);
    if (body.guard) body.guard->recall(gathered);
    Status status = method->start(begin, body.q, body.v);
    if (status == Status::ok) status = method->advance(end, body.observer());
    if (body.breached()) return Status::fatal;
    if (status != Status::ok) {
      body.failed_work +=
          total_work(method->stats(), static_cast<int>(method->q().size()));
      continue;
    }
    add_work(method->stats(), body.before);
    add_work(body.integrator->stats(), body.before);
    body.indicator =
        std::max({body.indicator, indicator_of(*body.integrator), indicator_of(*method)});
    return body.integrator->start(end, body.q, body.v);
  }
  body.gave_up = work_left(body) > 0;
  return Status::fatal;
}

/// Stores every state and passes it to the guard.
Observer World::Body::observer() {
  return [this](double at, In new_q, In new_v) {
    keep(at, new_q, new_v);
    return !guard || (*guard)(at, new_q, new_v);
  };
}

void World::Body::keep(double at, In new_q, In new_v) {
  t = at;
  q.assign(new_q.begin(), new_q.end());
  v.assign(new_v.begin(), new_v.end());
}

std::string World::failure_of(const Body& body) const {
  if (body.breached()) {
    return fmt::format("{}: {}; guard = false lets it go on",
                       body.guard->breach()->message(), remedy(integrator_.id, options_));
  }
  if (work_left(body) <= 0) {
    return fmt::format("{}: {}; max_work used up by shorter steps: {}", name_of(body),
                       body.integrator->failure(),
                       remedy(integrator_.id, options_, Limit::work));
  }
  return fmt::format(
      "{}: {}{}: {}", name_of(body), body.integrator->failure(),
      body.gave_up ? fmt::format(", nor for {:g} in its place", std::ldexp(1.0, halvings))
                   : "",
      remedy(integrator_.id, options_, body.integrator->limit()));
}

std::string World::name_of(const Body& body) const {
  const std::size_t last = body.first + body.coordinates.size() - 1;
  return fmt::format("strand {}{}", body.first,
                     last > body.first ? fmt::format(" to {}", last) : "");
}

const Breach* World::breach() const {
  const auto broken = std::ranges::find_if(bodies_, &Body::breached);
  return broken == bodies_.end() ? nullptr : &*broken->guard->breach();
}

std::optional<MethodDissipation> World::dissipation() const {
  MethodDissipation sum;
  if (interaction_ || mesh_ || rubbing_) return {};
  for (const Body& body : bodies_) {
    const bool known = body.guard && body.system->energetics() != nullptr &&
                       body.system->contact_form() == nullptr;
    if (!known) return {};
    sum += body.guard->dissipation();
  }
  return sum;
}

std::string World::not_smooth() const {
  for (const Body& body : bodies_) {
    const std::string why = tress::not_smooth(*body.system);
    if (!why.empty()) return name_of(body) + ": " + why;
  }
  return {};
}

Stats World::Body::stats() const {
  Stats sum = before;
  add_work(integrator->stats(), sum);
  return sum;
}

Stats World::stats() const {
  Stats sum = rubbing_ ? rubbing_->stats() : Stats{};
  for (const Body& body : bodies_) add_work(body.stats(), sum);
  return sum;
}

std::vector<long> World::steps() const {
  std::vector<long> of_strands;
  for (const Body& body : bodies_) {
    of_strands.insert(of_strands.end(), body.coordinates.size(), body.stats().steps);
  }
  return of_strands;
}

double World::work() const {
  double sum = 0;
  for (const Body& body : bodies_) {
    sum += total_work(body.stats(), static_cast<int>(body.integrator->q().size()));
  }
  return sum;
}

}  // namespace tress::simulation
