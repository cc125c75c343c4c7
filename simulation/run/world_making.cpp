// Makes a World: systems of its strands with their effects and guards, integrators at the
// initial state.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contract/input_error.h"
#include "math/pack.h"
#include "models/driven/driven_system.h"
#include "simulation/rest/overlap_at_start.h"
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

template <class Kind, class... Parts>
Kind& couple_by(std::vector<std::unique_ptr<StrandCoupling>>& all, Parts&&... parts) {
  auto made = std::make_unique<Kind>(std::forward<Parts>(parts)...);
  Kind& kind = *made;
  all.push_back(std::move(made));
  return kind;
}

}  // namespace

World::World(const Scene& scene, int threads, std::vector<HeldShape> held)
    : maker_(scene),
      stay_(scene.failed_strands == FailedStrands::stay),
      held_(std::move(held)),
      crew_(threads) {
  refuse_too_large(scene);
  if (scene.strands.empty()) {
    SteppedSystem made(scene.model->make(scene.model_options));
    if (scene.guard) {
      made.guard.emplace(
          Guard(*made.system, guarded_strands(*scene.model, scene.model_options)));
    }
    add(std::move(made), 1);
  } else if (const Parameters* between = scene.interaction();
             between != nullptr && between->word("coupling") == "monolithic") {
    build_coupled(scene, *between);
  } else {
    build_strands(scene, between);
  }
  ready(scene);
}

void World::add(SteppedSystem made, std::size_t strands, const StrandBlock* block) {
  Body& body = bodies_.emplace_back(std::move(made));
  if (bodies_.size() > 1) {
    const Body& last = bodies_[bodies_.size() - 2];
    body.first = last.first + last.coordinates.size();
    body.first_point = last.first_point + last.points;
  }
  System* const system = body.system.get();
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
  if (block == nullptr) {
    points_.insert(points_.end(), strands, static_cast<int>(body.points / strands));
    return;
  }
  body.memory.assign(strands, 0);
  body.memory.front() = system->memory().size();
  std::size_t all = 0;
  for (std::size_t k = 0; k < strands; ++k) {
    System& strand = block->strand(k);
    body.coordinates[k] = static_cast<std::size_t>(strand.layout().coordinates);
    all += body.coordinates[k];
    points_.push_back(strand.material_points()->count());
  }
  // Those of bodies come last.
  body.coordinates.back() += n - all;
}

Effects World::effects_between(std::size_t strand) const {
  Effects effects;
  for (const auto& coupling : couplings_) {
    if (auto effect = coupling->effect(strand)) effects.push_back(std::move(effect));
  }
  return effects;
}

/// Natural strains by which all strands are at rest.
void World::hold(const Scene& scene) {
  if (scene.rest != RestStrains::inverse) return;
  if (interaction_ != nullptr) {
    const std::vector<double> x = points_at_start(scene);
    interaction_->update(x, std::vector<double>(x.size()), loop());
  }
  if (held_.empty()) {
    held_ = held_shapes(
        scene, [this](std::size_t k) { return effects_between(k); }, crew_);
  }
  if (scene.unstable != Unstable::drop) return;
  const auto falls = std::ranges::find_if(held_, &HeldShape::falls);
  if (falls == held_.end()) return;
  throw InputError(
      fmt::format("strand {} would fall, and only simulate leaves strands out",
                  falls - held_.begin()),
      "unstable = \"drop\"", "use unstable = \"stiffen\" or \"keep\"");
}

/// Each strand separately, or up to four of equal discretisation together.
void World::build_strands(const Scene& scene, const Parameters* between) {
  if (between != nullptr) {
    interaction_ =
        &couple_by<LaggedInteraction>(couplings_, *between, material_points(scene)).law;
  }
  hold(scene);
  std::vector<Strand> stiffer_strands;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    stiffer_strands.push_back(stiffer(scene.strands[k], held_[k]));
  }
  const std::vector<Strand>& strands = held_.empty() ? scene.strands : stiffer_strands;
  if (const Parameters* mesh = scene.mesh(); mesh != nullptr) {
    mesh_ = &couple_by<MeshCoupling>(couplings_, *mesh, segment_lengths(strands)).mesh;
  }
  if (const Parameters* rubs = scene.friction(); rubs != nullptr) {
    friction_ =
        &couple_by<Rubbing>(couplings_, strands, *rubs, maker_.effects()).friction();
  }
  const auto to_make = [&](std::size_t k) {
    return StrandToMake{strands[k], effects_between(k),
                        held_.empty() ? nullptr : &held_[k], k};
  };
  // A failed strand must not take others with it.
  const bool alone = scene.failed_strands == FailedStrands::stay ||
                     scene.model->on_strands == nullptr || maker_.supports().any();
  const std::size_t most = alone ? 1 : Pack::lanes;
  for (std::size_t k = 0; k < strands.size();) {
    std::vector<StrandToMake> some;
    if (const SceneJoints::Group* group = maker_.joints().beginning_with(k)) {
      for (std::size_t i = k; i < k + group->count; ++i) some.push_back(to_make(i));
      SteppedSystem made = maker_.joined(some, *group);
      const StrandBlock* const block = models::block_of(*made.system);
      add(std::move(made), group->count, block);
      k += group->count;
      continue;
    }
    for (std::size_t i = k; i < strands.size() && i < k + most &&
                            strands[i].segments.size() == strands[k].segments.size() &&
                            maker_.joints().beginning_with(i) == nullptr;
         ++i) {
      some.push_back(to_make(i));
    }
    std::optional<SteppedSystem> made = maker_.together(some, k);
    const std::size_t count = made ? some.size() : 1;
    add(made ? std::move(*made) : maker_.one(some.front(), k), count);
    k += count;
  }
}

/// All strands as one system.
void World::build_coupled(const Scene& scene, const Parameters& between) {
  std::vector<std::unique_ptr<System>> systems;
  std::vector<StrandToMake> strands;
  std::vector<std::shared_ptr<const Metered>> meters;
  for (const Strand& strand : scene.strands) {
    strands.push_back({.strand = strand, .number = strands.size()});
    systems.push_back(maker_.metered(strands.back(), meters));
  }
  auto coupled = std::make_unique<CoupledStrands>(std::move(systems), between);
  CoupledStrands* const whole = coupled.get();
  SteppedSystem made(std::move(coupled));
  made.meters = std::move(meters);
  maker_.add_guard(made, strands, 0);
  add(std::move(made), scene.strands.size(), whole);
  bodies_.front().coupled = whole;
}

/// Integrators at the initial state.
void World::ready(const Scene& scene) {
  Snapshot begin;
  for (Body& body : bodies_) {
    body.take_method(scene.integrator, scene.options);
    for (const auto& coupling : couplings_) {
      coupling->add(*body.system, *body.integrator, scene.options);
    }
    const Snapshot::OfStrand all = body.initial_state();
    begin.add(all.q, all.v, all.memory, body.coordinates, body.memory);
  }
  const std::size_t points = bodies_.back().first_point + bodies_.back().points;
  x_.values.resize(3 * points);
  u_.values.resize(3 * points);
  x_.done.resize(bodies_.size());
  u_.done.resize(bodies_.size());
  restore(begin);
  overlap_ = overlap_at_start(scene, points_, positions());
  if (mesh_ == nullptr) return;
  mesh_->tie(positions());
  exchange();
}

}  // namespace tress::simulation
