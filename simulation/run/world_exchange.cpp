// Strands that exchange their motion at intervals under error control. An interval is run
// twice from its start: first the partners of every strand go straight on, then they go
// along cubics to where the first pass has left them. Straight on they miss their
// acceleration, a local error O(h^2) of the velocities that they drag along; the second
// pass leaves O(h^3) and is the result. Their difference estimates the error of the
// first.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrators/control/rewindable.h"
#include "integrators/control/step_factors.h"
#include "simulation/run/world.h"

namespace tress::simulation {
namespace {

/// Of the tolerance: the largest estimate in an interval.
constexpr double exchange_share = 1;
constexpr int exchange_power = 2;  // of the interval, as the estimate

/// Largest speed relative to the mean velocity.
double spread(In u) {
  const double count = static_cast<double>(u.size()) / 3;
  Vec mean;
  for (std::size_t i = 0; i < u.size(); i += 3) mean = mean + (1 / count) * load3(&u[i]);
  double most = 0;
  for (std::size_t i = 0; i < u.size(); i += 3) {
    most = std::max(most, norm(load3(&u[i]) - mean));
  }
  return most;
}

}  // namespace

/// After restore(). `time` is that in which the shortest strand falls about its length.
void World::start_control() {
  namespace factors = integrators::step_factors;
  control_.emplace(exchange_power);
  exchanges_ = {};
  double time = std::numeric_limits<double>::infinity();
  for (Body& body : bodies_) {
    body.norm.start(*body.system->material_points(), body.part(positions()));
    time = std::min(time, body.norm.typical_time());
  }
  control_->start(
      factors::first_part * time * std::sqrt(exchange_share * maker_.options().tolerance),
      std::max(maker_.options().min_step, factors::shortest_part * time));
}

Status World::advance_controlled(double t_end) {
  for (long taken = 0; t_ < t_end; ++taken) {
    if (taken >= maker_.options().max_steps) {
      failure_ = fmt::format("more than max_steps exchanges needed at t = {:.9g} s: {}",
                             t_, remedy_of(Limit::steps));
      return Status::fatal;
    }
    if (const Status s = next_interval(t_end); s != Status::ok) return s;
  }
  return Status::ok;
}

Status World::next_interval(double t_end) {
  const double begin = t_;
  const std::vector<double> x = positions(), u = velocities();
  double stop = t_end;
  for (Body& body : bodies_) {
    body.mark();
    stop = std::min(stop, body.system->next_breakpoint(begin));
  }
  // Two strands do not come nearer by more than the reach in an interval: they could pass
  // each other unseen.
  double longest = interaction_->reach() / (2 * spread(u));
  if (maker_.options().max_step > 0)
    longest = std::min(longest, maker_.options().max_step);
  for (;;) {
    const StepControl::Trial now = control_->next(stop - begin, longest);
    const double end = now.whole ? stop : begin + now.h;
    const bool last = end == t_end;
    Difference found;
    interaction_->extrapolate(begin, end, x, u, loop());
    bool solved = pass(begin, end,
                       [&](Body& body) { body.status = body.integrator->advance(end); });
    if (solved) {
      const std::vector<double> y = positions(), w = velocities();
      interaction_->interpolate(begin, end, x, u, y, w, loop());
      solved = pass(begin, end, [&](Body& body) { advance(body, end, last); });
      if (solved) found = difference(y, w);
    }
    if (solved && found.over <= 1) {
      control_->accept(now, found.over, begin);
      ++exchanges_.accepted;
      exchanges_.shortest = control_->shortest();
      exchange();
      return Status::ok;
    }
    if (const Status s = reject(now, solved ? &found : nullptr); s != Status::ok) {
      t_ = begin;
      return s;
    }
  }
}

/// Every strand from its mark at `begin` to `end`; false: one failed.
bool World::pass(double begin, double end, const std::function<void(Body&)>& run) {
  t_ = begin;
  crew_.run(bodies_.size(), [&](std::size_t k) {
    Body& body = bodies_[k];
    body.rewind();
    run(body);
  });
  t_ = end;
  x_.forget();
  u_.forget();
  return std::ranges::all_of(bodies_,
                             [](const Body& body) { return body.status == Status::ok; });
}

/// The largest of all strands between now and the positions y and velocities w.
World::Difference World::difference(In y, In w) {
  Difference largest;
  for (Body& body : bodies_) {
    const double size = body.norm.of(body.part(positions()), body.part(velocities()),
                                     body.part(y), body.part(w)) /
                        (exchange_share * maker_.options().tolerance);
    if (largest.body == nullptr || size > largest.over) largest = {size, &body};
  }
  return largest;
}

/// `found`: why, null: a strand failed. Not ok: the run ends.
Status World::reject(const StepControl::Trial& failed, const Difference* found) {
  ++exchanges_.rejected;
  if (found != nullptr) {
    control_->reject(failed, found->over);
    if (!control_->too_short()) return Status::ok;
    failure_ = fmt::format(
        "{}: tolerance {:g} needs exchanges with other strands less than {:.9g} s apart "
        "at t = {:.9g} s, for the error of the {}: {}",
        name_of(*found->body), maker_.options().tolerance, control_->least(),
        t_ - failed.h, found->body->norm.where(), remedy_of(Limit::none));
    return Status::fatal;
  }
  control_->unsolved(failed, "strand");
  const Body& body = *std::ranges::find_if(
      bodies_, [](const Body& one) { return one.status != Status::ok; });
  if (body.integrator->limit() == Limit::none && !control_->too_short()) {
    return Status::ok;
  }
  failure_ = failure_of(body);
  return body.status;
}

void World::Body::mark() {
  marked.q.assign(integrator->q().begin(), integrator->q().end());
  marked.v.assign(integrator->v().begin(), integrator->v().end());
  marked.memory = system->memory();
  if (guard) marked_guard = guard->memory();
  if (depth) marked_depth = depth->seen;
  marked_t = integrator->time();
  rewindable = dynamic_cast<Rewindable*>(integrator.get());
  rewindable->mark();
}

void World::Body::rewind() {
  // Copies, because accept() may write; where the state was accepted it does not.
  std::vector<double> old_q = marked.q, old_v = marked.v;
  system->recall(marked.memory);
  system->accept(marked_t, old_q, old_v);
  if (guard) guard->recall(marked_guard, marked_t, marked.q);
  if (depth) depth->seen = marked_depth;
  rewindable->rewind();
  status = Status::ok;
}

}  // namespace tress::simulation
