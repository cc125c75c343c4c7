// Advances a World: strands in parallel, with exchanges between them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contract/forms/moving_history.h"
#include "contract/forms/teleports.h"
#include "simulation/run/remedy.h"
#include "simulation/run/world.h"

namespace tress::simulation {
void add_exchanges(const Exchanges& from, Exchanges& to) {
  to.accepted += from.accepted;
  to.rejected += from.rejected;
  if (from.shortest.h == 0) return;
  if (to.shortest.h == 0 || from.shortest.h < to.shortest.h) to.shortest = from.shortest;
}

/// Returns the first teleport of any strand after the present time, or infinity.
double World::next_teleport() const {
  double next = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies_) {
    if (const Teleports* const own = teleports(*body.system)) {
      next = std::min(next, own->next_teleport(t_));
    }
  }
  return next;
}

/// Where strands are coupled, the step is the interval between exchanges, and each strand
/// takes one step in it.
void World::divide_steps(int parts) {
  parts_ = parts;
  if (!couplings_.empty()) return;
  for (Body& body : bodies_) body.parts = parts;
}

Status World::advance(double t_end) {
  // Strands see the others either before a teleport or after it.
  while (!couplings_.empty()) {
    const double at = next_teleport();
    if (at > t_end) break;
    const double before = models::just_before(at);
    Status s = before > t_ ? advance_between_teleports(before) : Status::ok;
    if (s == Status::ok) s = teleport(after_teleport(at, t_end));
    if (s != Status::ok) return s;
  }
  return t_ == t_end ? Status::ok : advance_between_teleports(t_end);
}

/// Methods that begin with the forces of the state start again once these are between
/// strands that have jumped.
Status World::teleport(double t) {
  crew_.run(bodies_.size(), [&](std::size_t k) { advance(bodies_[k], t, false); });
  t_ = t;
  x_.forget();
  u_.forget();
  if (const Status s = failed(); s != Status::ok) return s;
  exchange();
  crew_.run(bodies_.size(), [&](std::size_t k) {
    if (bodies_[k].status != Status::ok) return;
    bodies_[k].restart(maker_.method(), maker_.options(), t);
  });
  return failed();
}

Status World::advance_between_teleports(double t_end) {
  if (control_) return advance_controlled(t_end);
  // Without an exchange no strand has to wait for the others.
  const double span = t_end - t_;
  const double count =
      couplings_.empty()
          ? 1.0
          : parts_ * std::max(1.0, std::ceil(span / maker_.options().step - 1e-9));
  const double begin = t_;
  if (count > static_cast<double>(maker_.options().max_steps)) {
    failure_ = fmt::format("more than max_steps exchanges needed at t = {:.9g} s: {}", t_,
                           remedy_of(Limit::steps));
    return Status::fatal;
  }
  for (long i = 1; i <= static_cast<long>(count); ++i) {
    const double t = i == static_cast<long>(count)
                         ? t_end
                         : begin + static_cast<double>(i) * (span / count);
    const bool last = i == static_cast<long>(count);
    const double h = t - t_;
    for (const auto& coupling : couplings_) coupling->before_step(positions(), loop());
    x_.forget();
    u_.forget();
    crew_.run(bodies_.size(), [&](std::size_t k) {
      advance(bodies_[k], t, last);
      // What an exchange asks for costs least while the strand is near in memory.
      if (couplings_.empty() || bodies_[k].status != Status::ok) return;
      read_positions(k, t);
      read_velocities(k, t);
      for (const auto& coupling : couplings_) coupling->prepare(k, h);
    });
    t_ = t;
    if (const Status s = failed(); s != Status::ok) return s;
    if (const Status s = couple(h); s != Status::ok) return s;
    exchange();
  }
  return Status::ok;
}

/// Ends the run if a strand has failed, unless failed strands stay.
Status World::failed() {
  for (Body& body : bodies_) {
    if (body.status == Status::ok || body.stays()) continue;
    if (stay_) {
      lost_.push_back({body.first, body.t, body.failure()});
      body.stay(body.begun());
      x_.done[body.first] = u_.done[body.first] = 0;
      continue;
    }
    failure_ = failure_of(body);
    t_ = body.t;
    return body.status;
  }
  return Status::ok;
}

/// Couplings may give strands new states, after which all points are those of the new
/// ones.
Status World::couple(double h) {
  for (const auto& coupling : couplings_) {
    const Status done = coupling->after_step(t_, h, positions(), velocities(), loop());
    if (const auto moved = coupling->moved(); !moved.empty()) {
      std::size_t body = 0;
      for (const std::size_t k : moved) {
        while (k >= bodies_[body].first + bodies_[body].coordinates.size()) ++body;
        x_.done[body] = u_.done[body] = 0;
      }
      crew_.run(bodies_.size(), [&](std::size_t k) {
        if (x_.done[k] != 0) return;
        Body& touched = bodies_[k];
        touched.keep(t_, touched.integrator->q(), touched.integrator->v());
      });
    }
    if (done == Status::ok) continue;
    failure_ = coupling->failure();
    return done;
  }
  return Status::ok;
}

std::string World::failure_of(const Body& body) const {
  if (body.breached()) {
    return fmt::format("{}: {}; guard = false lets it go on", body.failure(),
                       remedy_of(Limit::none));
  }
  return fmt::format("{}: {}: {}", name_of(body), body.failure(),
                     remedy_of(body.limit()));
}

std::string World::remedy_of(Limit limit) const {
  if (limit == Limit::none && !overlap_.empty()) return overlap_;
  return remedy(maker_.method().id, maker_.options(), limit, maker_.model().id);
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
  if (!no_dissipation().empty()) return {};
  MethodDissipation sum;
  for (const Body& body : bodies_) sum += body.guard->dissipation();
  return sum;
}

Excess World::excess() const {
  Excess most;
  for (const Body& body : bodies_) {
    if (body.guard) most.take(body.guard->excess());
  }
  return most;
}

std::string World::no_dissipation() const {
  if (!couplings_.empty()) return std::string(touching_strands);
  for (const Body& body : bodies_) {
    if (std::string why = body.no_dissipation(); !why.empty()) return why;
  }
  return {};
}

void World::watch_depth() {
  depth_watched_ = true;
  for (Body& body : bodies_) {
    MaterialPoints* const seen = body.system->material_points();
    if (seen == nullptr) continue;
    if (BodyDepth depth(maker_.effects(), *seen); depth.any()) {
      body.depth.emplace(std::move(depth));
    }
  }
}

double World::take_depth() {
  if (!depth_watched_) watch_depth();
  double deepest = 0;
  for (Body& body : bodies_) {
    if (!body.depth) continue;
    deepest = std::max(deepest, std::exchange(body.depth->seen.deepest, 0.0));
  }
  return deepest;
}

std::optional<StrandPassage> World::passed() const {
  std::optional<StrandPassage> first;
  for (const Body& body : bodies_) {
    const auto missed = body.depth ? body.depth->seen.missed : std::nullopt;
    if (!missed || (first && first->contact.t <= missed->t)) continue;
    first = {body.first, *missed};
    std::size_t& point = first->contact.point;
    for (std::size_t& k = first->strand; point >= static_cast<std::size_t>(points_[k]);) {
      point -= static_cast<std::size_t>(points_[k++]);
    }
  }
  return first;
}

std::string World::not_smooth() const {
  for (const Body& body : bodies_) {
    const std::string why = tress::not_smooth(*body.system);
    if (!why.empty()) return name_of(body) + ": " + why;
  }
  return {};
}

Stats World::stats() const {
  Stats sum;
  for (const auto& coupling : couplings_) add_work(coupling->stats(), sum);
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
