#include "simulation/run/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/forms/joint_forces.h"
#include "contract/forms/support_forces.h"
#include "integrators/error_indicator.h"

namespace tress::simulation {

void Snapshot::add(In q, In v, In memory, const std::vector<std::size_t>& coordinates,
                   const std::vector<std::size_t>& memories) {
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const In one_q = q.first(coordinates[k]), one_v = v.first(coordinates[k]),
             one_memory = memory.first(memories[k]);
    strands.push_back({{one_q.begin(), one_q.end()},
                       {one_v.begin(), one_v.end()},
                       {one_memory.begin(), one_memory.end()}});
    q = q.subspan(coordinates[k]);
    v = v.subspan(coordinates[k]);
    memory = memory.subspan(memories[k]);
  }
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
    body.start(t_, std::move(all));
    const auto of_body = [&](const FailedStrand& one) {
      return one.strand == body.first;
    };
    if (std::ranges::any_of(snapshot.lost, of_body)) body.stay(body.integrator->q());
  }
  lost_ = snapshot.lost;
  failure_.clear();
  x_.forget();
  u_.forget();
  for (std::size_t k = 0; k < couplings_.size(); ++k) {
    couplings_[k]->restore(snapshot.couplings.empty() ? In() : snapshot.couplings[k]);
  }
  exchange();
  if (interaction_ != nullptr && maker_.options().tolerance > 0) start_control();
  for (Body& body : bodies_) {
    if (!body.guard) continue;
    if (guards.empty()) {
      body.guard->start(t_, body.integrator->q(), body.integrator->v());
    } else {
      body.guard->recall(guards.first(body.guard->remembered()), t_,
                         body.integrator->q());
      guards = guards.subspan(body.guard->remembered());
    }
  }
}

Snapshot World::snapshot() {
  Snapshot snapshot{.t = t_, .strands = {}, .guards = {}, .couplings = {}, .lost = lost_};
  for (const auto& coupling : couplings_) {
    snapshot.couplings.push_back(coupling->memory());
  }
  for (const Body& body : bodies_) {
    snapshot.add(body.seen_q(), body.seen_v(), body.system->memory(), body.coordinates,
                 body.memory);
    if (!body.guard) continue;
    const auto gathered = body.guard->memory();
    snapshot.guards.insert(snapshot.guards.end(), gathered.begin(), gathered.end());
  }
  return snapshot;
}

double World::error_indicator() const {
  double largest = 0;
  for (const Body& body : bodies_) {
    largest = std::max({largest, body.indicator, indicator_of(*body.integrator)});
  }
  return largest;
}

Energies World::energies() {
  Energies sum;
  sum.effects.resize(maker_.effects().size());
  for (const Body& body : bodies_) {
    Energetics* energetics = body.system->energetics();
    if (energetics == nullptr || body.stays()) continue;
    const In q = body.integrator->q(), v = body.integrator->v();
    const Energy one = energetics->energy(t_, q, v);
    double of_effects = 0;
    for (std::size_t i = 0; i < body.meters.size(); ++i) {
      sum.effects[i % maker_.effects().size()] += body.meters[i]->last();
      of_effects += body.meters[i]->last();
    }
    if (body.coupled != nullptr) of_effects += body.coupled->contact_potential(t_, q, v);
    if (DrivenBodies* const driven = tress::driven_bodies(*body.system)) {
      const Vec moment = driven->mass_moment(q);
      for (std::size_t i = 0; i < sum.effects.size(); ++i) {
        if (maker_.effects()[i]->name() != "gravity") continue;
        const double weight =
            -dot(maker_.effects()[i]->uniform_acceleration().value_or(Vec{}), moment);
        sum.effects[i] += weight;
        of_effects += weight;
      }
    }
    sum.kinetic += one.kinetic;
    sum.elastic += one.potential - of_effects;
  }
  return sum;
}

std::vector<ContactForce> World::contact_forces() {
  std::vector<ContactForce> all;
  for (const Body& body : bodies_) {
    Energetics* energetics = body.system->energetics();
    if (energetics == nullptr || body.stays()) continue;
    const auto look = [&](bool forces) {
      for (const auto& meter : body.meters) meter->look(forces && meter->contact());
    };
    look(true);
    static_cast<void>(energetics->energy(t_, body.integrator->q(), body.integrator->v()));
    look(false);
    for (std::size_t i = 0; i < body.meters.size(); ++i) {
      const Metered& meter = *body.meters[i];
      if (!meter.contact()) continue;
      for (std::size_t c = 0; c < meter.places().size(); c += 3) {
        all.push_back({body.first + i / maker_.effects().size(),
                       i % maker_.effects().size(), load3(&meter.places()[c]),
                       load3(&meter.forces()[c])});
      }
    }
  }
  return all;
}

std::vector<DrivenBodies::Motion> World::body_motions() const {
  std::vector<DrivenBodies::Motion> all;
  for (const Body& body : bodies_) {
    const DrivenBodies* const bodies = tress::driven_bodies(*body.system);
    for (std::size_t k = 0; bodies != nullptr && k < bodies->bodies(); ++k) {
      all.push_back(bodies->motion(body.seen_q(), body.seen_v(), k));
    }
  }
  return all;
}

World::SupportLoads World::support_loads() {
  SupportLoads all;
  const auto append = [&all](const Body& body, std::size_t count, const auto& read) {
    std::vector<double> forces(3 * count), moments = forces;
    const Status s = read(forces, moments);
    const auto add = [&](std::vector<double>& more, std::vector<double>& to) {
      if (s != Status::ok || body.stays()) std::ranges::fill(more, std::nan(""));
      to.insert(to.end(), more.begin(), more.end());
    };
    add(forces, all.forces);
    add(moments, all.moments);
  };
  for (const Body& body : bodies_) {
    SupportForces* const supports = tress::support_forces(*body.system);
    if (supports == nullptr) continue;
    std::vector<double> places(3 * supports->supports()), unused(2 * places.size());
    supports->support_motion(t_, places, Out(unused).first(places.size()),
                             Out(unused).last(places.size()));
    all.places.insert(all.places.end(), places.begin(), places.end());
    append(body, supports->supports(), [&](Out forces, Out moments) {
      return supports->support_forces(t_, body.seen_q(), body.seen_v(), forces, moments);
    });
  }
  for (const Body& body : bodies_) {
    JointForces* const joints = tress::joint_forces(*body.system);
    if (joints == nullptr) continue;
    append(body, joints->joints(), [&](Out forces, Out moments) {
      return joints->joint_forces(t_, body.seen_q(), body.seen_v(), forces, moments);
    });
  }
  return all;
}

std::vector<std::string> World::supported_starts() const {
  std::vector<std::string> all;
  for (const Body& body : bodies_) {
    if (body.supported.steps == 0) continue;
    all.push_back(fmt::format(
        "{} begins at rest on its supports: its points were up to {:.3g} m{} away "
        "({} steps, forces in balance within {:.1g})",
        name_of(body), body.supported.moved,
        body.supported.turned > 0
            ? fmt::format(" and its ends {:.3g} rad", body.supported.turned)
            : "",
        body.supported.steps, body.supported.unbalanced));
  }
  return all;
}

double World::drive() const {
  double fastest = friction_ == nullptr ? 0 : friction_->drive();
  for (const Body& body : bodies_) {
    const ContactForm* const form = body.system->contact_form();
    if (form != nullptr) fastest = std::max(fastest, form->drive());
  }
  return fastest;
}

double World::stretch() {
  double most = 0;
  for (const Body& body : bodies_) {
    MaterialPoints* points = body.system->material_points();
    if (points == nullptr || body.stays()) continue;
    most = std::max(most, points->stretch(t_, body.integrator->q()).value_or(0));
  }
  return most;
}

const std::vector<double>& World::positions() {
  look(x_, &World::read_positions);
  return x_.values;
}

const std::vector<double>& World::velocities() {
  look(u_, &World::read_velocities);
  return u_.values;
}

void World::read_positions(std::size_t k, double t) {
  if (std::exchange(x_.done[k], 1) != 0 || bodies_[k].points == 0) return;
  const Body& body = bodies_[k];
  body.system->material_points()->positions(t, body.seen_q(), x_.of(body));
}

void World::read_velocities(std::size_t k, double t) {
  if (std::exchange(u_.done[k], 1) != 0 || bodies_[k].points == 0) return;
  const Body& body = bodies_[k];
  body.system->material_points()->velocities(t, body.seen_q(), body.seen_v(),
                                             u_.of(body));
}

void World::exchange() {
  for (const auto& coupling : couplings_) {
    coupling->exchange(positions(), velocities(), loop());
  }
}

Loop World::loop() {
  return [this](std::size_t count, const std::function<void(std::size_t)>& work) {
    crew_.run(count, work);
  };
}

void World::look(const Read& known, void (World::*read)(std::size_t, double)) {
  if (std::ranges::find(known.done, 0) == known.done.end()) return;
  crew_.run(bodies_.size(), [&](std::size_t k) { (this->*read)(k, t_); });
}

}  // namespace tress::simulation
