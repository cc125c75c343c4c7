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
                   "use linearly_implicit_euler or backward_euler");
}

}  // namespace

Rubbing::Rubbing(const std::vector<Strand>& strands, const Parameters& rubs,
                 const Effects& effects)
    : friction_(rubs, searched(strands), obstacles(effects)) {}

void Rubbing::add_responder(System& system, std::size_t strands, std::size_t coordinate,
                            const Options& options) {
  const auto points = static_cast<std::size_t>(system.material_points()->count());
  const std::size_t group = groups_.size() - 1, number = responders_.size();
  Responder& all = responders_.emplace_back();
  all.system = &system;
  all.response = std::make_unique<ImpulseResponse>(system, *groups_.back().method,
                                                   options, coordinate);
  all.group = group;
  all.first = responder_of_.size();
  all.strands = strands;
  all.coordinate = coordinate;
  all.points = points / strands;
  all.v_before.resize(static_cast<std::size_t>(system.layout().coordinates));
  all.placed.resize(3 * points);
  responder_of_.insert(responder_of_.end(), strands, number);
}

void Rubbing::add(System& strands, Integrator& method, const Options& options) {
  Group& group = groups_.emplace_back();
  group.method = &method;
  group.impulsive = &impulsive(method);
  group.first = responder_of_.size();
  group.first_responder = responders_.size();
  const auto* const block = dynamic_cast<StrandBlock*>(&strands);
  group.strands = block == nullptr ? 1 : block->strands();
  group.responders = 1;
  if (block == nullptr || block->responds_at_once()) {
    add_responder(strands, group.strands, 0, options);
    return;
  }
  group.responders = group.strands;
  std::size_t coordinate = 0;
  for (std::size_t k = 0; k < group.strands; ++k) {
    System& strand = block->strand(k);
    add_responder(strand, 1, coordinate, options);
    coordinate += static_cast<std::size_t>(strand.layout().coordinates);
  }
}

void Rubbing::restore(In memory) {
  friction_.recall(memory);
  for (Responder& responder : responders_) responder.touches = false;
  for (const std::size_t k : friction_.touching()) {
    responders_[responder_of_[k]].touches = true;
  }
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
  for (Responder& responder : of(groups_[k])) {
    if (!std::exchange(responder.touches, false)) continue;
    groups_[k].impulsive->lose_matrix();
    // Of strands that respond together, the first question finds all answers.
    if (prepare(responder, h) == Status::ok && responder.strands > 1) {
      (void)responder.response->compliance({}, responder.blocks);
    }
  }
}

Status Rubbing::prepare(Responder& responder, double h) {
  if (!responder.prepared) {
    responder.prepared = responder.response->prepare(h, responder.v_before);
  }
  return *responder.prepared;
}

/// What responds of these strands, ascending, and which they are.
Status Rubbing::each(Some strands, double t, const Loop& loop,
                     const std::function<Status(Responder&, Some)>& act) {
  std::vector<Some> of_responders;
  for (std::size_t from = 0, to = 0; from < strands.size(); from = to) {
    while (to < strands.size() &&
           responder_of_[strands[to]] == responder_of_[strands[from]]) {
      ++to;
    }
    of_responders.push_back(strands.subspan(from, to - from));
  }
  const auto of = [this](Some some) -> Responder& {
    return responders_[responder_of_[some.front()]];
  };
  loop(of_responders.size(), [&](std::size_t i) {
    Responder& responder = of(of_responders[i]);
    responder.status = act(responder, of_responders[i]);
  });
  for (const Some some : of_responders) {
    const Responder& responder = of(some);
    if (responder.status == Status::ok) continue;
    failure_ = no_response(responder.first, responder.strands, t);
    return responder.status;
  }
  return Status::ok;
}

Status Rubbing::give_compliance(Responder& responder, Some strands, double h) {
  if (const Status done = prepare(responder, h); done != Status::ok) return done;
  for (const std::size_t k : strands) {
    const auto first = static_cast<int>((k - responder.first) * responder.points);
    responder.touched = friction_.points_of(k);
    for (int& point : responder.touched) point += first;
    const Status done =
        responder.response->compliance(responder.touched, responder.blocks);
    if (done != Status::ok) return done;
    friction_.respond(k, responder.blocks);
  }
  return Status::ok;
}

/// To the forces on all its strands; only those that have moved are placed.
Status Rubbing::respond(Responder& responder, Some moved, double t) {
  responder.touched.clear();
  responder.forces.clear();
  for (std::size_t k = 0; k < responder.strands; ++k) {
    const In forces = friction_.forces(responder.first + k);
    if (forces.empty()) continue;
    for (const int point : friction_.points_of(responder.first + k)) {
      responder.touched.push_back(static_cast<int>(k * responder.points) + point);
    }
    responder.forces.insert(responder.forces.end(), forces.begin(), forces.end());
  }
  const Status done = responder.response->respond(responder.touched, responder.forces);
  responder.system->material_points()->positions(t, responder.response->q(),
                                                 responder.placed);
  const std::size_t numbers = 3 * responder.points;
  for (const std::size_t k : moved) {
    friction_.place(
        k, In(responder.placed).subspan((k - responder.first) * numbers, numbers));
  }
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
      Responder& responder = responders_[responder_of_[k]];
      responder.touches = true;
      const std::size_t n = responder.v_before.size() / responder.strands,
                        first = (k - responder.first) * n;
      const auto at = static_cast<std::ptrdiff_t>(responder.coordinate + first);
      std::ranges::copy(responder.response->q().subspan(first, n), group.q.begin() + at);
      std::ranges::copy(responder.response->v().subspan(first, n), group.v.begin() + at);
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
    const Status known =
        each(friction_.stale(), t, loop, [&](Responder& responder, Some strands) {
          return give_compliance(responder, strands, h);
        });
    if (known != Status::ok) return known;
    friction_.solve(loop);
    const Status moved =
        each(friction_.moved(), t, loop, [&](Responder& responder, Some strands) {
          return respond(responder, strands, t);
        });
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
