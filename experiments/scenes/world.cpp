#include "experiments/scenes/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "integrators/catalogue.h"
#include "integrators/error_indicator.h"
#include "models/groom/coupled_strands.h"
#include "models/math/pack.h"

namespace tress {
namespace {

/// Root and tips of segments of every strand.
std::vector<int> material_points(const Scene& scene) {
  std::vector<int> points;
  for (const Strand& strand : scene.strands) {
    points.push_back(static_cast<int>(strand.segments.size()) + 1);
  }
  return points;
}

Snapshot::OfStrand initial_state_of(const System& system) {
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  Snapshot::OfStrand state{std::vector<double>(n), std::vector<double>(n),
                           system.memory()};
  system.initial_state(state.q, state.v);
  return state;
}

void append_strands(In q, In v, In memory, const std::vector<std::size_t>& coordinates,
                    const std::vector<std::size_t>& memories, Snapshot& snapshot) {
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const In one_q = q.first(coordinates[k]), one_v = v.first(coordinates[k]),
             one_memory = memory.first(memories[k]);
    snapshot.strands.push_back({{one_q.begin(), one_q.end()},
                                {one_v.begin(), one_v.end()},
                                {one_memory.begin(), one_memory.end()}});
    q = q.subspan(coordinates[k]);
    v = v.subspan(coordinates[k]);
    memory = memory.subspan(memories[k]);
  }
}

}  // namespace

Effects make_effects(const Scene& scene) {
  Effects all;
  for (const EffectChoice& choice : scene.effects) {
    all.push_back(choice.entry->make(choice.parameters, scene.head));
  }
  return all;
}

std::vector<std::string> effect_names(const Scene& scene) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    const std::string_view id = scene.effects[i].entry->id;
    const auto so_far = std::ranges::count(
        scene.effects.begin(), scene.effects.begin() + static_cast<std::ptrdiff_t>(i), id,
        [](const EffectChoice& choice) { return choice.entry->id; });
    std::string name(id);
    if (so_far > 0) name.append("_").append(std::to_string(so_far + 1));
    names.push_back(std::move(name));
  }
  return names;
}

World::World(const Scene& scene, int threads)
    : step_(scene.options.step), crew_(threads) {
  if (scene.strands.empty()) {
    add(scene.model->make(scene.model_options), 1);
    if (scene.guard) guard(guarded_strands(*scene.model, scene.model_options));
  } else if (scene.interaction && scene.interaction->word("coupling") == "monolithic") {
    build_coupled(scene);
  } else {
    build_strands(scene);
  }
  ready(scene);
}

void World::add(std::unique_ptr<System> system, std::size_t strands) {
  Body& body = bodies_.emplace_back();
  if (bodies_.size() > 1) {
    const Body& last = bodies_[bodies_.size() - 2];
    body.first = last.first + last.coordinates.size();
    body.first_point = last.first_point + last.points;
  }
  // Strands of one system are alike, unless the caller says otherwise.
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  body.coordinates.assign(strands, n / strands);
  body.memory.assign(strands, system->memory().size() / strands);
  MaterialPoints* points = system->material_points();
  body.points = points == nullptr ? 0 : static_cast<std::size_t>(points->count());
  for (std::size_t i = 0; i < body.points; ++i) {
    const int before = points->before(static_cast<int>(i));
    before_.push_back(before < 0 ? -1 : before + static_cast<int>(body.first_point));
  }
  points_.insert(points_.end(), strands, static_cast<int>(body.points / strands));
  body.system = std::move(system);
}

/// Of the last body.
void World::guard(std::vector<GuardedStrand> strands) {
  Body& body = bodies_.back();
  body.guard.emplace(*body.system, std::move(strands), body.first);
}

/// None where the scene wants no guard.
std::vector<GuardedStrand> World::guarded(const Scene& scene, std::size_t first,
                                          std::size_t count,
                                          const Effects& shared) const {
  std::vector<GuardedStrand> all;
  for (std::size_t k = first; k < first + count; ++k) {
    Effects effects = shared;
    if (interaction_) effects.push_back(interaction_->effect(k));
    all.push_back(guarded_strand(scene.strands[k], std::move(effects)));
  }
  return all;
}

/// Each strand on its own, or up to four that are cut alike together.
void World::build_strands(const Scene& scene) {
  const std::vector<Strand>& strands = scene.strands;
  if (scene.interaction) {
    interaction_ =
        std::make_unique<StrandInteraction>(*scene.interaction, material_points(scene));
  }
  const Effects shared = make_effects(scene);
  const auto effects_of = [&](std::size_t k) {
    Effects effects = shared;
    if (interaction_) effects.push_back(interaction_->effect(k));
    return effects;
  };
  for (std::size_t k = 0; k < strands.size();) {
    std::size_t end = k + 1;
    while (end < strands.size() && end < k + Pack::lanes &&
           strands[end].segments.size() == strands[k].segments.size()) {
      ++end;
    }
    if (scene.model->on_strands != nullptr && end > k + 1) {
      std::vector<Effects> effects;
      for (std::size_t i = k; i < end; ++i) effects.push_back(effects_of(i));
      auto system = scene.model->on_strands(std::span(strands).subspan(k, end - k),
                                            scene.model_options, std::move(effects));
      if (system != nullptr) {
        add(std::move(system), end - k);
        if (scene.guard) guard(guarded(scene, k, end - k, shared));
        k = end;
        continue;
      }
    }
    add(scene.model->on_strand(strands[k], scene.model_options, effects_of(k)), 1);
    if (scene.guard) guard(guarded(scene, k, 1, shared));
    ++k;
  }
}

/// All strands as one system.
void World::build_coupled(const Scene& scene) {
  const Effects shared = make_effects(scene);
  std::vector<std::unique_ptr<System>> systems;
  std::vector<std::size_t> coordinates, memory;
  for (const Strand& strand : scene.strands) {
    systems.push_back(scene.model->on_strand(strand, scene.model_options, shared));
    coordinates.push_back(static_cast<std::size_t>(systems.back()->layout().coordinates));
    memory.push_back(systems.back()->memory().size());
  }
  add(std::make_unique<CoupledStrands>(std::move(systems), *scene.interaction),
      scene.strands.size());
  bodies_.front().coordinates = std::move(coordinates);
  bodies_.front().memory = std::move(memory);
  points_ = material_points(scene);
  if (scene.guard) guard(guarded(scene, 0, scene.strands.size(), shared));
}

/// Integrators at the initial state.
void World::ready(const Scene& scene) {
  Snapshot begin;
  for (Body& body : bodies_) {
    body.integrator = make_integrator(scene.integrator, *body.system, scene.options);
    const Snapshot::OfStrand all = initial_state_of(*body.system);
    append_strands(all.q, all.v, all.memory, body.coordinates, body.memory, begin);
  }
  const std::size_t points = bodies_.back().first_point + bodies_.back().points;
  remedy_ = remedy(scene.integrator, scene.options);
  x_.values.resize(3 * points);
  u_.values.resize(3 * points);
  restore(begin);
}

void World::restore(const Snapshot& snapshot) {
  t_ = snapshot.t;
  In guards = snapshot.guards;
  for (Body& body : bodies_) {
    Snapshot::OfStrand all;
    for (std::size_t k = 0; k < body.coordinates.size(); ++k) {
      const Snapshot::OfStrand& one = snapshot.strands[body.first + k];
      all.q.insert(all.q.end(), one.q.begin(), one.q.end());
      all.v.insert(all.v.end(), one.v.begin(), one.v.end());
      all.memory.insert(all.memory.end(), one.memory.begin(), one.memory.end());
    }
    body.system->recall(all.memory);
    // Contact sets follow the state; where it was accepted before, nothing changes.
    body.system->accept(t_, all.q, all.v);
    body.status = body.integrator->start(t_, all.q, all.v);
  }
  failure_.clear();
  x_.done = u_.done = false;
  exchange();
  for (Body& body : bodies_) {
    if (!body.guard) continue;
    if (guards.empty()) {
      body.guard->start(t_, body.integrator->q(), body.integrator->v());
    } else {
      body.guard->recall(guards.first(Guard::remembered));
      guards = guards.subspan(Guard::remembered);
    }
  }
}

Snapshot World::snapshot() const {
  Snapshot snapshot{.t = t_, .strands = {}, .guards = {}};
  for (const Body& body : bodies_) {
    append_strands(body.integrator->q(), body.integrator->v(), body.system->memory(),
                   body.coordinates, body.memory, snapshot);
    if (!body.guard) continue;
    const auto gathered = body.guard->memory();
    snapshot.guards.insert(snapshot.guards.end(), gathered.begin(), gathered.end());
  }
  return snapshot;
}

Status World::advance(double t_end) {
  // Without an exchange nobody needs to wait for the others.
  const double span = t_end - t_;
  const double count = interaction_ ? std::max(1.0, std::ceil(span / step_ - 1e-9)) : 1.0;
  const double begin = t_;
  for (long i = 1; i <= static_cast<long>(count); ++i) {
    const double t = i == static_cast<long>(count)
                         ? t_end
                         : begin + static_cast<double>(i) * (span / count);
    const bool last = i == static_cast<long>(count);
    crew_.run(bodies_.size(), [&](std::size_t k) { advance(bodies_[k], t, last); });
    t_ = t;
    x_.done = u_.done = false;
    for (const Body& body : bodies_) {
      if (body.status == Status::ok) continue;
      failure_ = failure_of(body);
      return body.status;
    }
    exchange();
  }
  return Status::ok;
}

/// Its guard sees the last state of all, also where the method gave up there.
void World::advance(Body& body, double t, bool last) {
  if (body.status != Status::ok) return;
  Integrator& method = *body.integrator;
  if (!body.guard) {
    body.status = method.advance(t);
    return;
  }
  body.status = method.advance(
      t, [&guard = *body.guard](double at, In q, In v) { return guard(at, q, v); });
  if (body.guard->breach() || (body.status == Status::ok && !last)) return;
  if (!body.guard->judge(method.time(), method.q(), method.v())) {
    body.status = Status::fatal;
  }
}

std::string World::failure_of(const Body& body) const {
  if (body.guard && body.guard->breach()) {
    return fmt::format("{}: {}; guard = false lets it go on",
                       body.guard->breach()->message(), remedy_);
  }
  const std::size_t last = body.first + body.coordinates.size() - 1;
  return fmt::format("strand {}{}: {}", body.first,
                     last > body.first ? fmt::format(" to {}", last) : "",
                     body.integrator->failure());
}

Stats World::stats() const {
  Stats sum;
  for (const Body& body : bodies_) {
    const Stats one = body.integrator->stats();
    sum.steps += one.steps;
    sum.newton_iterations += one.newton_iterations;
    sum.solver = one.solver;
  }
  return sum;
}

double World::error_indicator() const {
  double largest = 0;
  for (const Body& body : bodies_) {
    const ErrorIndicator* own = tress::error_indicator(*body.integrator);
    if (own != nullptr) largest = std::max(largest, own->largest_indicator());
  }
  return largest;
}

Energy World::energy() {
  Energy sum;
  for (const Body& body : bodies_) {
    Energetics* energetics = body.system->energetics();
    if (energetics == nullptr) continue;
    const Energy one = energetics->energy(t_, body.integrator->q(), body.integrator->v());
    sum.kinetic += one.kinetic;
    sum.potential += one.potential;
  }
  return sum;
}

double World::stretch() {
  double most = 0, one = 0;
  for (const Body& body : bodies_) {
    MaterialPoints* points = body.system->material_points();
    if (points != nullptr && points->stretch(t_, body.integrator->q(), one)) {
      most = std::max(most, one);
    }
  }
  return most;
}

const std::vector<double>& World::positions() {
  look(
      [&](Body& body, Out of_strand) {
        body.system->material_points()->positions(t_, body.integrator->q(), of_strand);
      },
      x_);
  return x_.values;
}

const std::vector<double>& World::velocities() {
  look(
      [&](Body& body, Out of_strand) {
        body.system->material_points()->velocities(t_, body.integrator->q(),
                                                   body.integrator->v(), of_strand);
      },
      u_);
  return u_.values;
}

void World::exchange() {
  if (interaction_) interaction_->update(positions(), velocities());
}

void World::look(const std::function<void(Body&, Out)>& read, Read& to) {
  if (to.done) return;
  crew_.run(bodies_.size(), [&](std::size_t k) {
    const std::size_t count = 3 * bodies_[k].points;
    if (count > 0) {
      read(bodies_[k], Out(to.values).subspan(3 * bodies_[k].first_point, count));
    }
  });
  to.done = true;
}

}  // namespace tress
