// Energy of joined strands, and the forces of supports and joints at a state.
#include <algorithm>
#include <cmath>

#include "contract/forms/energetics.h"
#include "models/joints/joined_system.h"
#include "models/supports/kinetic_rate.h"

namespace tress::models {

Energy JoinedSystem::energy(double t, In q, In v) {
  Energy sum = StrandBlock::energy(t, q, v);
  for (JointPair& joint : joints_) sum.potential += joint.energy(t, q);
  return sum;
}

/// Accelerations and multipliers of g'' = 0 at a state, and the accelerations of the
/// strands without supports and joints.
Status JoinedSystem::hold(double t, In q, In v) noexcept {
  last_.replace();
  Status s = factor(t, q, v, zero_, {}, {1, 0, 0});
  for (std::size_t k = 0; k < strands() && s == Status::ok; ++k) {
    s = held_[k]->strand().residual(t, part(q, k), part(v, k), part(In(zero_), k),
                                    part(Out(alone_), k));
  }
  if (s == Status::ok) s = residual(t, q, v, zero_, acceleration_);
  if (s != Status::ok) return s;
  for (auto* x : {&alone_, &acceleration_}) {
    for (double& entry : *x) entry = -entry;
  }
  if (s = solve_strands(alone_); s != Status::ok) return s;
  if (rows_->rows() == 0) return solve_factored(acceleration_);
  for (const Status next :
       {rows_->gradient(t, q, gradient_), rows_->bias(t, q, v, lambda_)}) {
    if (next != Status::ok) return next;
  }
  for (double& entry : lambda_) entry = -entry;
  s = eliminated_->factor(gradient_, gradient_);
  return s == Status::ok ? eliminated_->solve(acceleration_, lambda_) : s;
}

std::size_t JoinedSystem::supports() const {
  std::size_t all = 0;
  for (const SupportedSystem* strand : held_) all += strand->supports();
  return all;
}

Status JoinedSystem::support_forces(double t, In q, In v, Out forces, Out moments) {
  if (supports() == 0) return Status::ok;
  if (const Status s = hold(t, q, v); s != Status::ok) return s;
  for (std::size_t k = 0; k < strands(); ++k) {
    const std::size_t own = 3 * held_[k]->supports();
    held_[k]->loads_of(t, part(q, k), part(v, k), rows_->of_strand(lambda_, k),
                       forces.first(own), moments.first(own));
    forces = forces.subspan(own);
    moments = moments.subspan(own);
  }
  return Status::ok;
}

void JoinedSystem::support_motion(double t, Out x, Out u, Out omega) const {
  for (const SupportedSystem* strand : held_) {
    const std::size_t own = 3 * strand->supports();
    strand->support_motion(t, x.first(own), u.first(own), omega.first(own));
    x = x.subspan(own);
    u = u.subspan(own);
    omega = omega.subspan(own);
  }
}

Status JoinedSystem::joint_forces(double t, In q, In v, Out forces, Out moments) {
  if (const Status s = hold(t, q, v); s != Status::ok) return s;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const JointLoad load = joints_[j].load(t, q, v, rows_->of_joint(lambda_, j));
    store3(load.force, &forces[3 * j]);
    store3(load.moment, &moments[3 * j]);
  }
  return Status::ok;
}

double JoinedSystem::power_into_bodies(double t, In q, In v) {
  if (hold(t, q, v) != Status::ok) return std::nan("");
  double sum = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (body(ends_[2 * j].strand) == nullptr) continue;
    const JointLoad load = joints_[j].load(t, q, v, rows_->of_joint(lambda_, j));
    JointEnd& end = joints_[j].end(0);
    sum -= dot(load.force, end.velocity(t, q, v));
    if (norm(load.moment) > 0) {
      sum -= dot(load.moment, end.section(t, q, v, zero_).omega);
    }
  }
  return sum;
}

double JoinedSystem::moment_power(double t, In q, In v, const Vec& turning) {
  double sum = 0;
  for (std::size_t k = 0; k < strands(); ++k) {
    sum += held_[k]->moment_power(t, part(q, k), part(v, k), turning);
  }
  return sum;
}

bool JoinedSystem::natural_moves() const {
  return std::ranges::any_of(held_, &SupportedSystem::natural_moves);
}

/// Of the natural strains that were set last.
double JoinedSystem::potential_as_set(double t, In q) {
  double sum = 0;
  for (std::size_t k = 0; k < strands(); ++k) {
    sum += held_[k]->potential_as_set(t, part(q, k));
  }
  for (JointPair& joint : joints_) sum += joint.energy(t, q);
  return sum;
}

double JoinedSystem::natural_power(double t, In q) {
  return power_of_natural(held_, t, [&] { return potential_as_set(t, q); });
}

NaturalWork JoinedSystem::natural_work(double from, In q_from, double to, In q_to) {
  return work_of_natural(held_, from, to, [&](bool end) {
    return potential_as_set(end ? to : from, end ? q_to : q_from);
  });
}

/// As that of SupportedSystem: what supports and joints change of the strands'
/// accelerations changes the kinetic energy, and halves and springs store energy.
double JoinedSystem::power(double t, In q, In v) {
  double sum = natural_power(t, q);
  if (hold(t, q, v) != Status::ok) return std::nan("");
  for (std::size_t k = 0; k < strands(); ++k) {
    const In q_k = part(q, k), v_k = part(v, k);
    sum += held_[k]->strand().energetics()->power(t, q_k, v_k) +
           held_[k]->added_energy_rate(t, q_k, v_k);
  }
  for (JointPair& joint : joints_) sum += joint.energy_rate(t, q, v);
  for (std::size_t i = 0; i < scratch_.size(); ++i) {
    scratch_[i] = acceleration_[i] - alone_[i];
  }
  return sum + kinetic_rate(*this, t, q, v, scratch_, v_typ_);
}

}  // namespace tress::models
