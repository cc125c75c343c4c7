#include "experiments/scenes/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "integrators/catalogue.h"
#include "models/input_error.h"

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

}  // namespace

Effects make_effects(const Scene& scene) {
  Effects all;
  for (const EffectChoice& choice : scene.effects) {
    all.push_back(choice.entry->make(choice.parameters, scene.head));
  }
  return all;
}

World::World(const Scene& scene, int threads)
    : step_(scene.options.step), crew_(threads) {
  if (scene.interaction) {
    interaction_ =
        std::make_unique<StrandInteraction>(*scene.interaction, material_points(scene));
  }
  if (scene.strands.empty()) {
    bodies_.emplace_back().system = scene.model->make(scene.model_options);
  }
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    Effects effects = make_effects(scene);
    if (interaction_) effects.push_back(interaction_->effect(k));
    bodies_.emplace_back().system =
        scene.model->on_strand(scene.strands[k], scene.model_options, std::move(effects));
  }
  std::size_t point = 0;
  Snapshot begin;
  for (Body& body : bodies_) {
    body.integrator = make_integrator(scene.integrator, *body.system, scene.options);
    MaterialPoints* points = body.system->material_points();
    points_.push_back(points == nullptr ? 0 : points->count());
    body.first_point = point;
    point += static_cast<std::size_t>(points_.back());
    begin.strands.push_back(initial_state_of(*body.system));
  }
  x_.resize(3 * point);
  u_.resize(3 * point);
  restore(begin);
}

void World::restore(const Snapshot& snapshot) {
  t_ = snapshot.t;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Snapshot::OfStrand& state = snapshot.strands[k];
    bodies_[k].system->recall(state.memory);
    bodies_[k].status = bodies_[k].integrator->start(t_, state.q, state.v);
  }
  failure_.clear();
  exchange();
}

Snapshot World::snapshot() const {
  Snapshot snapshot{.t = t_, .strands = {}};
  for (const Body& body : bodies_) {
    const In q = body.integrator->q(), v = body.integrator->v();
    snapshot.strands.push_back(
        {{q.begin(), q.end()}, {v.begin(), v.end()}, body.system->memory()});
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
    crew_.run(bodies_.size(), [&](std::size_t k) {
      Body& body = bodies_[k];
      if (body.status == Status::ok) body.status = body.integrator->advance(t);
    });
    t_ = t;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (bodies_[k].status == Status::ok) continue;
      failure_ = fmt::format("strand {}: {}", k, bodies_[k].integrator->failure());
      return bodies_[k].status;
    }
    exchange();
  }
  return Status::ok;
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

const std::vector<double>& World::positions() {
  look(
      [&](Body& body, Out of_strand) {
        body.system->material_points()->positions(t_, body.integrator->q(), of_strand);
      },
      x_);
  return x_;
}

const std::vector<double>& World::velocities() {
  look(
      [&](Body& body, Out of_strand) {
        body.system->material_points()->velocities(t_, body.integrator->q(),
                                                   body.integrator->v(), of_strand);
      },
      u_);
  return u_;
}

void World::exchange() {
  if (interaction_) interaction_->update(positions(), velocities());
}

void World::look(const std::function<void(Body&, Out)>& read, std::vector<double>& to) {
  crew_.run(bodies_.size(), [&](std::size_t k) {
    const auto count = 3 * static_cast<std::size_t>(points_[k]);
    if (count > 0) read(bodies_[k], Out(to).subspan(3 * bodies_[k].first_point, count));
  });
}

}  // namespace tress
