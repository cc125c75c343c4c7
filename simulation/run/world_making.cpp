// Makes a World: systems of its strands with their effects and guards, integrators at the
// initial state.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contract/input_error.h"
#include "contract/natural_strains.h"
#include "integrators/catalogue.h"
#include "math/pack.h"
#include "simulation/run/memory.h"
#include "simulation/run/world.h"

namespace tress::simulation {
namespace {

/// Root and tips of segments of every strand.
std::vector<int> material_points(const Scene& scene) {
  std::vector<int> points;
  for (const Strand& strand : scene.strands) {
    points.push_back(static_cast<int>(strand.segments.size()) + 1);
  }
  return points;
}

Snapshot::OfStrand initial_state_of(System& system) {
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  Snapshot::OfStrand state{std::vector<double>(n), std::vector<double>(n),
                           system.memory()};
  system.initial_state(state.q, state.v);
  return state;
}

/// Wraps each effect in a Metered, stored in `meters`.
Effects metered(const Effects& effects,
                std::vector<std::shared_ptr<const Metered>>& meters) {
  Effects all;
  for (const auto& effect : effects) {
    meters.push_back(std::make_shared<Metered>(effect));
    all.push_back(meters.back());
  }
  return all;
}

}  // namespace

World::World(const Scene& scene, int threads, std::vector<HeldShape> held)
    : integrator_(find_integrator(scene.integrator)),
      options_(scene.options),
      effects_(make_effects(scene)),
      held_(std::move(held)),
      crew_(threads) {
  refuse_too_large(scene);
  if (scene.strands.empty()) {
    add(scene.model->make(scene.model_options), 1);
    if (scene.guard) guard(guarded_strands(*scene.model, scene.model_options));
  } else if (const Parameters* between = scene.interaction();
             between != nullptr && between->word("coupling") == "monolithic") {
    build_coupled(scene, *between);
  } else {
    build_strands(scene, between);
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
  // Strands of one system have equal sizes unless the caller changes them.
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

/// Adds a guard to the last body.
void World::guard(std::vector<GuardedStrand> strands) {
  Body& body = bodies_.back();
  body.guard.emplace(*body.system, std::move(strands), body.first);
}

/// `first`: number of the first of these strands.
std::vector<GuardedStrand> World::guarded(std::span<const Strand> strands,
                                          std::size_t first) const {
  std::vector<GuardedStrand> all;
  for (std::size_t k = 0; k < strands.size(); ++k) {
    Effects effects = effects_on(first + k);
    add_effects_between(first + k, effects);
    all.push_back(guarded_strand(strands[k], std::move(effects)));
  }
  return all;
}

void World::add_effects_between(std::size_t strand, Effects& effects) const {
  if (interaction_) effects.push_back(interaction_->effect(strand));
  if (mesh_) effects.push_back(mesh_->effect(strand));
}

/// Natural strains by which all strands are at rest.
void World::hold(const Scene& scene) {
  if (scene.rest != RestStrains::inverse) return;
  if (interaction_) {
    const std::vector<double> x = points_at_start(scene);
    interaction_->update(x, std::vector<double>(x.size()), loop());
  }
  if (held_.empty()) {
    held_ = held_shapes(
        scene,
        [this](std::size_t k) {
          return interaction_ ? Effects{interaction_->effect(k)} : Effects{};
        },
        crew_);
  }
  if (scene.unstable != Unstable::drop) return;
  const auto falls = std::ranges::find_if(held_, &HeldShape::falls);
  if (falls == held_.end()) return;
  throw InputError(
      fmt::format("strand {} would fall, and only simulate leaves strands out",
                  falls - held_.begin()),
      "unstable = \"drop\"", "use unstable = \"stiffen\" or \"keep\"");
}

/// Those of the scene on each strand.
Effects World::effects_on(std::size_t strand) const {
  return held_.empty() ? effects_ : supporting(effects_, held_[strand]);
}

/// Each strand separately, or up to four of equal discretisation together.
void World::build_strands(const Scene& scene, const Parameters* between) {
  if (between != nullptr) {
    interaction_ = std::make_unique<StrandInteraction>(*between, material_points(scene));
  }
  hold(scene);
  std::vector<Strand> stiffer_strands;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    stiffer_strands.push_back(stiffer(scene.strands[k], held_[k]));
  }
  const std::vector<Strand>& strands = held_.empty() ? scene.strands : stiffer_strands;
  if (const Parameters* mesh = scene.mesh(); mesh != nullptr) {
    mesh_ = std::make_unique<ControlMesh>(*mesh, segment_lengths(strands));
  }
  if (const Parameters* rubs = scene.friction(); rubs != nullptr) {
    rubbing_ = std::make_unique<Rubbing>(strands, *rubs, effects_);
  }
  std::vector<std::shared_ptr<const Metered>> meters;  // of the body being built
  const auto effects_of = [&](std::size_t k) {
    Effects effects = metered(effects_on(k), meters);
    add_effects_between(k, effects);
    return effects;
  };
  const auto hold_last = [&](std::size_t first, std::size_t end) {
    if (held_.empty()) return;
    std::vector<double> natural;
    for (std::size_t k = first; k < end; ++k) {
      natural.insert(natural.end(), held_[k].natural.begin(), held_[k].natural.end());
    }
    natural_strains(*bodies_.back().system)->set_natural(natural);
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
        hold_last(k, end);
        bodies_.back().meters = std::exchange(meters, {});
        if (scene.guard) guard(guarded(std::span(strands).subspan(k, end - k), k));
        k = end;
        continue;
      }
      meters.clear();
    }
    add(scene.model->on_strand(strands[k], scene.model_options, effects_of(k)), 1);
    hold_last(k, k + 1);
    bodies_.back().meters = std::exchange(meters, {});
    if (scene.guard) guard(guarded(std::span(strands).subspan(k, 1), k));
    ++k;
  }
}

/// All strands as one system.
void World::build_coupled(const Scene& scene, const Parameters& between) {
  std::vector<std::unique_ptr<System>> systems;
  std::vector<std::size_t> coordinates;
  std::vector<std::shared_ptr<const Metered>> meters;
  for (const Strand& strand : scene.strands) {
    systems.push_back(
        scene.model->on_strand(strand, scene.model_options, metered(effects_, meters)));
    coordinates.push_back(static_cast<std::size_t>(systems.back()->layout().coordinates));
  }
  auto coupled = std::make_unique<CoupledStrands>(std::move(systems), between);
  CoupledStrands* const whole = coupled.get();
  add(std::move(coupled), scene.strands.size());
  Body& body = bodies_.front();
  body.coupled = whole;
  body.meters = std::move(meters);
  body.coordinates = std::move(coordinates);
  // Its memory is more than that of its strands: all of it is stored with the first.
  body.memory.assign(scene.strands.size(), 0);
  body.memory.front() = body.system->memory().size();
  points_ = material_points(scene);
  if (scene.guard) guard(guarded(scene.strands, 0));
}

/// Integrators at the initial state.
void World::ready(const Scene& scene) {
  Snapshot begin;
  for (Body& body : bodies_) {
    body.integrator = make_integrator(scene.integrator, *body.system, scene.options);
    body.rewindable = dynamic_cast<Rewindable*>(body.integrator.get());
    if (rubbing_) rubbing_->add(*body.system, *body.integrator, scene.options);
    const Snapshot::OfStrand all = initial_state_of(*body.system);
    begin.add(all.q, all.v, all.memory, body.coordinates, body.memory);
  }
  const std::size_t points = bodies_.back().first_point + bodies_.back().points;
  x_.values.resize(3 * points);
  u_.values.resize(3 * points);
  x_.done.resize(bodies_.size());
  u_.done.resize(bodies_.size());
  restore(begin);
  if (!mesh_) return;
  mesh_->tie(positions());
  exchange();
}

}  // namespace tress::simulation
