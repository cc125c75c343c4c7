// Exact contact between the strands of a World: they move as if they were alone, then
// impulses at the end of the step keep them from passing through each other.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contract/input_error.h"
#include "simulation/run/world.h"

namespace tress::simulation {

void World::make_friction(const std::vector<Strand>& strands, const Parameters& rubs) {
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
  std::vector<std::shared_ptr<const Obstacle>> obstacles;
  for (const auto& effect : effects_) {
    if (auto obstacle = std::dynamic_pointer_cast<const Obstacle>(effect)) {
      obstacles.push_back(std::move(obstacle));
    }
  }
  friction_ = std::make_unique<StrandFriction>(rubs, all, obstacles);
}

void World::before_step() {
  x_before_ = positions();
  for (Body& body : bodies_) {
    body.v_before.assign(body.integrator->v().begin(), body.integrator->v().end());
  }
}

Status World::rub(double h) {
  friction_->begin(t_, h, x_before_, positions(), velocities());
  const auto each = [&](std::span<const std::size_t> strands, const auto& act) {
    crew_.run(strands.size(), [&](std::size_t i) {
      Body& body = bodies_[strands[i]];
      body.status = act(body, strands[i]);
    });
    for (const std::size_t k : strands) {
      if (bodies_[k].status == Status::ok) continue;
      failure_ = fmt::format(
          "strand {}: no response to the forces of others at t = {:.9g} s", k, t_);
      return bodies_[k].status;
    }
    return Status::ok;
  };
  const models::Loop loop = [&](std::size_t count,
                                const std::function<void(std::size_t)>& work) {
    crew_.run(count, work);
  };
  std::vector<char> prepared(bodies_.size());  // its matrix is that of this step
  while (friction_->find(loop)) {
    const Status s = each(friction_->stale(), [&](Body& body, std::size_t k) -> Status {
      const std::vector<int>& points = friction_->points_of(k);
      std::vector<double> blocks;
      Status done = Status::ok;
      if (!std::exchange(prepared[k], 1)) done = body.response->prepare(h, body.v_before);
      if (done == Status::ok) done = body.response->compliance(points, blocks);
      friction_->respond(k, blocks);
      return done;
    });
    if (s != Status::ok) return s;
    friction_->solve();
    const Status moved =
        each(friction_->touching(), [&](Body& body, std::size_t k) -> Status {
          const Status done =
              body.response->respond(friction_->points_of(k), friction_->forces(k));
          std::vector<double> x(3 * body.points);
          body.system->material_points()->positions(t_, body.response->q(), x);
          friction_->place(k, x);
          return done;
        });
    if (moved != Status::ok) return moved;
  }
  const Status s = each(friction_->touching(), [&](Body& body, std::size_t) {
    const Status done = body.response->go_on();
    body.keep(t_, body.integrator->q(), body.integrator->v());
    return done;
  });
  x_.done = u_.done = false;
  rubbed_.contact_iterations += friction_->outcome().sweeps;
  if (friction_->outcome().violation > friction_->tolerance()) {
    ++rubbed_.contact_unfinished;
    rubbed_.contact_violation =
        std::max(rubbed_.contact_violation, friction_->outcome().violation);
  }
  return s;
}

}  // namespace tress::simulation
