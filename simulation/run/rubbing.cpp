#include "simulation/run/rubbing.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace

Rubbing::Rubbing(const std::vector<Strand>& strands, const Parameters& rubs,
                 const Effects& effects)
    : friction_(rubs, searched(strands), obstacles(effects)) {}

void Rubbing::add(System& system, Integrator& method, const Options& options) {
  strands_.push_back({&system,
                      &method,
                      std::make_unique<ImpulseResponse>(system, method, options),
                      static_cast<std::size_t>(system.material_points()->count()),
                      {}});
}

void Rubbing::restart(In memory) {
  friction_.recall(memory);
  stats_ = {};
  failure_.clear();
}

void Rubbing::before_step(In x) {
  x_before_.assign(x.begin(), x.end());
  for (Rubbed& strand : strands_) {
    strand.v_before.assign(strand.method->v().begin(), strand.method->v().end());
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
    failure_ = fmt::format(
        "strand {}: no response to the forces of others at t = {:.9g} s", k, t);
    return strands_[k].status;
  }
  return Status::ok;
}

Status Rubbing::after_step(double t, double h, In x, In u, const Loop& loop) {
  friction_.begin(t, h, x_before_, x, u);
  while (friction_.find(loop)) {
    const Status known =
        each(friction_.stale(), t, loop, [&](Rubbed& strand, std::size_t k) {
          std::vector<double> blocks;
          Status done = Status::ok;
          if (!std::exchange(strand.prepared, true)) {
            done = strand.response->prepare(h, strand.v_before);
          }
          if (done == Status::ok) {
            done = strand.response->compliance(friction_.points_of(k), blocks);
          }
          friction_.respond(k, blocks);
          return done;
        });
    if (known != Status::ok) return known;
    friction_.solve(loop);
    const Status moved =
        each(friction_.moved(), t, loop, [&](Rubbed& strand, std::size_t k) {
          const Status done =
              strand.response->respond(friction_.points_of(k), friction_.forces(k));
          std::vector<double> placed(3 * strand.points);
          strand.system->material_points()->positions(t, strand.response->q(), placed);
          friction_.place(k, placed);
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
  return each(friction_.touching(), t, loop,
              [](Rubbed& strand, std::size_t) { return strand.response->go_on(); });
}

}  // namespace tress::simulation
