#include "simulation/run/rubbing.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contract/input_error.h"
#include "models/groom/strand_block.h"

namespace tress::simulation {
namespace {

std::vector<PieceSearch::Strand> searched(const std::vector<Strand>& strands) {
  std::vector<PieceSearch::Strand> all;
  for (std::size_t k = 0; k < strands.size(); ++k) {
    PieceSearch::Strand& own = all.emplace_back();
    own.points = static_cast<int>(strands[k].segments.size()) + 1;
    for (std::size_t i = 0; i < strands[k].segments.size(); ++i) {
      const Segment& segment = strands[k].segments[i];
      if (segment.parent != static_cast<int>(i) - 1) {
        throw InputError(fmt::format("strand {} has branches", k),
                         "effects.strand_friction", "give strands without branches");
      }
      own.radius = std::max({own.radius, segment.section.a1, segment.section.a2});
      own.longest = std::max(own.longest, segment.length);
    }
  }
  return all;
}

std::vector<std::shared_ptr<const Obstacle>> obstacles(const Effects& effects) {
  std::vector<std::shared_ptr<const Obstacle>> all;
  for (const auto& effect : effects) {
    if (auto obstacle = std::dynamic_pointer_cast<const Obstacle>(effect)) {
      all.push_back(std::move(obstacle));
    }
  }
  return all;
}

/// Of strands that are solved as one system: any of them.
std::string no_response(std::size_t first, std::size_t strands, double t) {
  return fmt::format("strand{}: no response to the forces of others at t = {:.9g} s",
                     strands == 1 ? fmt::format(" {}", first)
                                  : fmt::format("s {} to {}", first, first + strands - 1),
                     t);
}

Impulsive& impulsive(Integrator& method) {
  auto* able = dynamic_cast<Impulsive*>(&method);
  if (able != nullptr) return *able;
  throw InputError("the method cannot go on after the impulses of strands that rub",
                   "effects.strand_friction",
                   "use linearly_implicit_euler, backward_euler or guarded");
}

}  // namespace

Rubbing::Rubbing(const std::vector<Strand>& strands, const Parameters& rubs,
                 const Effects& effects)
    : friction_(rubs, searched(strands), obstacles(effects)) {}

void Rubbing::add(System& strands, Integrator& method, const Options& options) {
  const auto* const block = dynamic_cast<StrandBlock*>(&strands);
  const std::size_t count = block == nullptr ? 1 : block->strands();
  groups_.push_back({&method, &impulsive(method), responders_.size(), count, {}, {}});
  std::size_t coordinate = 0;
  for (std::size_t k = 0; k < count; ++k) {
    System& strand = block == nullptr ? strands : block->strand(k);
    const auto coordinates = static_cast<std::size_t>(strand.layout().coordinates);
    const auto points = static_cast<std::size_t>(strand.material_points()->count());
    Responder& added = responders_.emplace_back();
    added.system = &strand;
    added.response =
        std::make_unique<ImpulseResponse>(strand, method, options, coordinate);
    added.group = groups_.size() - 1;
    added.coordinate = coordinate;
    added.v_before.resize(coordinates);
    added.placed.resize(3 * points);
    coordinate += coordinates;
  }
}

void Rubbing::restore(In memory) {
  friction_.recall(memory);
  for (Responder& responder : responders_) responder.touches = false;
  for (const std::size_t k : friction_.touching()) responders_[k].touches = true;
  stats_ = {};
  failure_.clear();
}

void Rubbing::before_step(In x, const Loop& loop) {
  x_before_.assign(x.begin(), x.end());
  loop(responders_.size(), [&](std::size_t i) {
    Responder& responder = responders_[i];
    const In v = groups_[responder.group].method->v();
    std::ranges::copy(v.subspan(responder.coordinate, responder.v_before.size()),
                      responder.v_before.begin());
    responder.prepared = {};
  });
}

void Rubbing::prepare(std::size_t k, double h) {
  const Group& group = groups_[k];
  for (Responder& responder :
       std::span(responders_).subspan(group.first, group.strands)) {
    if (!std::exchange(responder.touches, false)) continue;
    group.impulsive->lose_matrix();
    static_cast<void>(prepare(responder, h));
  }
}

Status Rubbing::prepare(Responder& responder, double h) {
  if (!responder.prepared) {
    responder.prepared = responder.response->prepare(h, responder.v_before);
  }
  return *responder.prepared;
}

/// For each of these strands, ascending.
Status Rubbing::each(Some strands, double t, const Loop& loop,
                     const std::function<Status(std::size_t)>& act) {
  loop(strands.size(),
       [&](std::size_t i) { responders_[strands[i]].status = act(strands[i]); });
  for (const std::size_t k : strands) {
    const Status status = responders_[k].status;
    if (status == Status::ok) continue;
    failure_ = no_response(k, 1, t);
    return status;
  }
  return Status::ok;
}

Status Rubbing::give_compliance(std::size_t k, double h) {
  Responder& responder = responders_[k];
  if (const Status done = prepare(responder, h); done != Status::ok) return done;
  const Status done =
      responder.response->compliance(friction_.points_of(k), responder.blocks);
  if (done == Status::ok) friction_.respond(k, responder.blocks);
  return done;
}

Status Rubbing::respond(std::size_t k, double t) {
  Responder& responder = responders_[k];
  const In forces = friction_.forces(k);
  const Status done = responder.response->respond(
      forces.empty() ? std::span<const int>() : friction_.points_of(k), forces);
  responder.system->material_points()->positions(t, responder.response->q(),
                                                 responder.placed);
  friction_.place(k, responder.placed);
  return done;
}

/// Methods of strands that others touched, from the states that these have left.
Status Rubbing::go_on(double t, const Loop& loop) {
  const std::span<const std::size_t> touching = friction_.touching();
  loop(groups_.size(), [&](std::size_t g) {
    Group& group = groups_[g];
    group.status = Status::ok;
    const auto from = std::ranges::lower_bound(touching, group.first),
               to = std::ranges::lower_bound(touching, group.first + group.strands);
    if (from == to) return;
    group.q.assign(group.method->q().begin(), group.method->q().end());
    group.v.assign(group.method->v().begin(), group.method->v().end());
    for (const std::size_t k : std::span(from, to)) {
      Responder& responder = responders_[k];
      responder.touches = true;
      const auto at = static_cast<std::ptrdiff_t>(responder.coordinate);
      std::ranges::copy(responder.response->q(), group.q.begin() + at);
      std::ranges::copy(responder.response->v(), group.v.begin() + at);
    }
    group.status = group.impulsive->go_on(group.q, group.v);
  });
  for (const Group& group : groups_) {
    if (group.status == Status::ok) continue;
    failure_ = no_response(group.first, group.strands, t);
    return group.status;
  }
  return Status::ok;
}

Status Rubbing::after_step(double t, double h, In x, In u, const Loop& loop) {
  friction_.begin(t, h, x_before_, x, u);
  while (friction_.find(loop)) {
    const Status known = each(friction_.stale(), t, loop,
                              [&](std::size_t k) { return give_compliance(k, h); });
    if (known != Status::ok) return known;
    friction_.solve(loop);
    const Status moved =
        each(friction_.moved(), t, loop, [&](std::size_t k) { return respond(k, t); });
    if (moved != Status::ok) return moved;
  }
  stats_.contact_iterations += friction_.outcome().sweeps;
  if (friction_.outcome().violation > friction_.tolerance()) {
    ++stats_.contact_unfinished;
    stats_.contact_violation =
        std::max(stats_.contact_violation, friction_.outcome().violation);
  }
  return go_on(t, loop);
}

}  // namespace tress::simulation
