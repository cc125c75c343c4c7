#include "simulation/run/rubbing.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contract/input_error.h"

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

std::string no_response(std::size_t strand, double t) {
  return fmt::format("strand {}: no response to the forces of others at t = {:.9g} s",
                     strand, t);
}

Impulsive& impulsive(Integrator& method) {
  auto* able = dynamic_cast<Impulsive*>(&method);
  if (able != nullptr) return *able;
  throw InputError("the method cannot go on after the impulses of strands that rub",
                   "effects.strand_friction",
                   "use semi_implicit_euler or backward_euler");
}

}  // namespace

Rubbing::Rubbing(const std::vector<Strand>& strands, const Parameters& rubs,
                 const Effects& effects)
    : friction_(rubs, searched(strands), obstacles(effects)) {}

void Rubbing::add(std::span<System* const> strands, Integrator& method,
                  const Options& options) {
  Group& group = groups_.emplace_back();
  group.method = &method;
  group.impulsive = &impulsive(method);
  group.first = strands_.size();
  std::size_t first = 0;  // coordinate
  for (System* const strand : strands) {
    const auto points = static_cast<std::size_t>(strand->material_points()->count());
    strands_.push_back(
        {strand,
         std::make_unique<ImpulseResponse>(*strand, method, options, first),
         points,
         groups_.size() - 1,
         first,
         {},
         {},
         {}});
    strands_.back().v_before.resize(
        static_cast<std::size_t>(strand->layout().coordinates));
    first += strands_.back().v_before.size();
  }
}

void Rubbing::restart(In memory) {
  friction_.recall(memory);
  stats_ = {};
  failure_.clear();
}

void Rubbing::before_step(In x) {
  x_before_.assign(x.begin(), x.end());
  for (Rubbed& strand : strands_) {
    const In v = groups_[strand.group].method->v();
    std::ranges::copy(v.subspan(strand.first, strand.v_before.size()),
                      strand.v_before.begin());
    strand.prepared = false;
  }
}

Status Rubbing::each(std::span<const std::size_t> strands, double t, const Loop& loop,
                     const std::function<Status(Rubbed&, std::size_t)>& act) {
  loop(strands.size(), [&](std::size_t i) {
    Rubbed& strand = strands_[strands[i]];
    strand.status = act(strand, strands[i]);
  });
  for (const std::size_t k : strands) {
    if (strands_[k].status == Status::ok) continue;
    failure_ = no_response(k, t);
    return strands_[k].status;
  }
  return Status::ok;
}

/// Methods of strands that others touched, from the states that these have left.
Status Rubbing::go_on(double t, const Loop& loop) {
  for (const std::size_t k : friction_.touching()) {
    const Rubbed& strand = strands_[k];
    Group& group = groups_[strand.group];
    if (!std::exchange(group.touched, true)) {
      group.q.assign(group.method->q().begin(), group.method->q().end());
      group.v.assign(group.method->v().begin(), group.method->v().end());
    }
    const auto first = static_cast<std::ptrdiff_t>(strand.first);
    std::ranges::copy(strand.response->q(), group.q.begin() + first);
    std::ranges::copy(strand.response->v(), group.v.begin() + first);
  }
  loop(groups_.size(), [&](std::size_t g) {
    Group& group = groups_[g];
    group.status = std::exchange(group.touched, false)
                       ? group.impulsive->go_on(group.q, group.v)
                       : Status::ok;
  });
  for (const Group& group : groups_) {
    if (group.status == Status::ok) continue;
    failure_ = no_response(group.first, t);
    return group.status;
  }
  return Status::ok;
}

Status Rubbing::after_step(double t, double h, In x, In u, const Loop& loop) {
  friction_.begin(t, h, x_before_, x, u);
  while (friction_.find(loop)) {
    const Status known =
        each(friction_.stale(), t, loop, [&](Rubbed& strand, std::size_t k) {
          Status done = Status::ok;
          if (!std::exchange(strand.prepared, true)) {
            done = strand.response->prepare(h, strand.v_before);
          }
          if (done == Status::ok) {
            done = strand.response->compliance(friction_.points_of(k), strand.blocks);
          }
          friction_.respond(k, strand.blocks);
          return done;
        });
    if (known != Status::ok) return known;
    friction_.solve(loop);
    const Status moved =
        each(friction_.moved(), t, loop, [&](Rubbed& strand, std::size_t k) {
          const Status done =
              strand.response->respond(friction_.points_of(k), friction_.forces(k));
          strand.placed.resize(3 * strand.points);
          strand.system->material_points()->positions(t, strand.response->q(),
                                                      strand.placed);
          friction_.place(k, strand.placed);
          return done;
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
