#include "models/supports/added_forces.h"

#include <algorithm>
#include <limits>
#include <string>

namespace tress::models {
namespace {

/// A half edge and the spring of a compliant support in series, for slow rotations c. The
/// spring turns by the share k_edge/(k_edge + k_spring) of c, the half edge by the rest.
double friction_in_series(double edge, double spring, double edge_friction,
                          double spring_friction) {
  const double of_spring = edge / (edge + spring), of_edge = 1 - of_spring;
  return of_spring * of_spring * spring_friction + of_edge * of_edge * edge_friction;
}

/// Stiffness and friction between the wall and the frame of the model.
RodJoint joint_of(const Support& support, bool half_edge) {
  const double k = support.compliance.turn_stiffness, c = support.compliance.turn_damping;
  if (!support.turn_sprung()) return support.half_edge;
  if (!half_edge) return {{}, {k, k, k}, {c, c, c}};
  const RodJoint& edge = support.half_edge;
  const auto stiffness = [k](double of_edge) {
    return of_edge > 0 ? of_edge * k / (of_edge + k) : 0;
  };
  const auto friction = [&](double of_edge, double friction_of_edge) {
    return of_edge > 0 ? friction_in_series(of_edge, k, friction_of_edge, c) : c;
  };
  const Vec &a = edge.stiffness, &b = edge.friction;
  return {{},
          {stiffness(a.x), stiffness(a.y), stiffness(a.z)},
          {friction(a.x, b.x), friction(a.y, b.y), friction(a.z, b.z)}};
}

}  // namespace

AddedForces::AddedForces(System& strand, const std::vector<Support>& supports,
                         std::vector<PointMoment> moments, const NaturalMotion& natural) {
  SparseForm* const matrix = strand.sparse_form();
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const Support& support = supports[i];
    const std::string where = "support " + std::to_string(i);
    if (support.sprung()) {
      springs_.emplace_back(i, PointSpring(strand, support, matrix, where));
    }
    if (support.section == HeldPart::nothing) continue;
    HeldSection section(strand, support.point, support.path,
                        support.section == HeldPart::frame, support.hinge, matrix, where);
    const bool half_edge = section.half_edge();
    if (!half_edge && !support.turn_sprung()) continue;
    if (half_edge && natural.any()) section.follow(natural.turn(support.point > 0));
    joints_.push_back(
        {i, support.turn_sprung(),
         HalfJoint(std::move(section), joint_of(support, half_edge), support.begin)});
  }
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const std::string where = "moment " + std::to_string(i);
    for (const Support& support : supports) {
      refuse_on_support(strand, moments[i], support, where);
    }
    moments_.emplace_back(strand, std::move(moments[i]), matrix, where);
  }
}

void AddedForces::add_moments(double t, In q, InOut r) {
  for (MomentOnSection& moment : moments_) moment.add_force(t, q, r);
}

void AddedForces::add_to_residual(double t, In q, In v, InOut r) {
  for (Joint& one : joints_) one.joint.add_force(t, q, v, r);
  for (auto& [support, spring] : springs_) spring.add_force(t, q, v, r);
  add_moments(t, q, r);
}

void AddedForces::add_tangent(double t, In q, In v, Weights w, InOut s) {
  for (Joint& one : joints_) one.joint.add_tangent(t, q, v, w, s);
  for (auto& [support, spring] : springs_) spring.add_tangent(t, q, v, w, s);
  for (MomentOnSection& moment : moments_) moment.add_tangent(t, q, w.pos, s);
}

void AddedForces::append_loads(double t, In q, In v, std::vector<SectionLoad>& loads) {
  for (Joint& one : joints_) loads.push_back(one.joint.load(t, q, v));
  for (auto& [support, spring] : springs_) loads.push_back(spring.load(t, q, v));
  for (MomentOnSection& moment : moments_) loads.push_back(moment.load(t, q));
}

double AddedForces::energy(double t, In q) {
  double sum = 0;
  for (Joint& one : joints_) sum += one.joint.energy(t, q);
  for (auto& [support, spring] : springs_) sum += spring.energy(t, q);
  return sum;
}

double AddedForces::energy_rate(double t, In q, In v) {
  double sum = 0;
  for (Joint& one : joints_) sum += one.joint.energy_rate(t, q, v);
  for (auto& [support, spring] : springs_) sum += spring.energy_rate(t, q, v);
  return sum;
}

double AddedForces::power_of_moments(double t, In q, In v, const Vec& turning) {
  double sum = 0;
  for (MomentOnSection& moment : moments_) sum += moment.power(t, q, v, turning);
  return sum;
}

void AddedForces::write_support_forces(double t, In q, In v, Out forces, Out moments) {
  for (Joint& one : joints_) {
    store3(one.joint.load(t, q, v).moment, &moments[3 * one.support]);
  }
  for (auto& [support, spring] : springs_) {
    store3(spring.load(t, q, v).force, &forces[3 * support]);
  }
}

double AddedForces::next_breakpoint(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const MomentOnSection& one : moments_)
    next = std::min(next, one.next_breakpoint(t));
  return next;
}

void AddedForces::joint_rotations(double t, In q, Out c) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    store3(joints_[j].compliant ? Vec{} : joints_[j].joint.rotation(t, q), &c[3 * j]);
  }
}

void AddedForces::lead_joints(In by) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    joints_[j].joint.lead(load3(&by[3 * j]));
  }
}

}  // namespace tress::models
