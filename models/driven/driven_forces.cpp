// Energy of strands and the bodies that they drive, and the forces of supports and
// joints.
#include "contract/forms/energetics.h"
#include "models/driven/driven_system.h"

namespace tress::models {

Status DrivenSystem::support_forces(double t, In q, In v, Out forces, Out moments) {
  if (supports_ == nullptr) return Status::ok;
  place(q, v);
  return recorded([&] {
    return supports_->support_forces(t, of_strand(q), of_strand(v), forces, moments);
  });
}

void DrivenSystem::support_motion(double t, Out x, Out u, Out omega) const {
  if (supports_ != nullptr) supports_->support_motion(t, x, u, omega);
}

double DrivenSystem::moment_power(double t, In q, In v, const Vec& turning) {
  if (supports_ == nullptr) return 0;
  return supports_->moment_power(t, of_strand(q), of_strand(v), turning);
}

double DrivenSystem::natural_power(double t, In q) {
  return supports_ == nullptr ? 0 : supports_->natural_power(t, of_strand(q));
}

NaturalWork DrivenSystem::natural_work(double from, In q_from, double to, In q_to) {
  if (supports_ == nullptr) return {};
  return supports_->natural_work(from, of_strand(q_from), to, of_strand(q_to));
}

Status DrivenSystem::joint_forces(double t, In q, In v, Out forces, Out moments) {
  if (joints_ == nullptr) return Status::ok;
  place(q, v);
  return recorded([&] {
    return joints_->joint_forces(t, of_strand(q), of_strand(v), forces, moments);
  });
}

Energy DrivenSystem::energy(double t, In q, In v) {
  place(q, v);
  Energy sum = strand_->energetics()->energy(t, of_strand(q), of_strand(v));
  static_cast<void>(each_loose([&](BodySystem& body, std::size_t k) {
    const Energy own = body.energy(t, of_body(q, k), of_body(v, k));
    sum.kinetic += own.kinetic;
    sum.potential += own.potential;
    return Status::ok;
  }));
  return sum;
}

std::optional<Momentum> DrivenSystem::momentum(double t, In q, In v) {
  std::optional<Momentum> sum =
      strand_->energetics()->momentum(t, of_strand(q), of_strand(v));
  static_cast<void>(each_loose([&](BodySystem& body, std::size_t k) {
    const Momentum own = *body.momentum(t, of_body(q, k), of_body(v, k));
    for (std::size_t i = 0; i < 3 && sum; ++i) {
      sum->linear[i] += own.linear[i];
      sum->angular[i] += own.angular[i];
    }
    return Status::ok;
  }));
  return sum;
}

Vec DrivenSystem::mass_moment(In q) const {
  Vec sum;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (const auto* body = std::get_if<FreeBody>(&bodies_[k].effect->drive())) {
      sum = sum + body->mass * load3(of_body(q, k).data());
    }
  }
  return sum;
}

DrivenBodies::OfBodies DrivenSystem::energy_of_bodies(double t, In q, In v) {
  place(q, v);
  static_cast<void>(recorded(
      [&] { return strand_->residual(t, of_strand(q), of_strand(v), zero_, r_); }));
  OfBodies all;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const auto& [effect, system, first, size, column, member] = bodies_[k];
    const Motion now = motion(q, v, k);
    const BodyWrench contact = effect->recorded();
    const Energy own = system->energy(t, of_body(q, k), of_body(v, k));
    all.kinetic += own.kinetic;
    all.potential += own.potential;
    all.rate += system->power(t, of_body(q, k), of_body(v, k));
    all.from_strands += dot(contact.force, now.v) + dot(contact.moment, now.omega);
  }
  if (joined_ != nullptr && joints_->joints() > 0) {
    static_cast<void>(recorded([&] {
      all.from_strands += joined_->power_into_bodies(t, of_strand(q), of_strand(v));
      return Status::ok;
    }));
  }
  all.rate += all.from_strands;
  return all;
}

double DrivenSystem::power(double t, In q, In v) {
  place(q, v);
  double sum = 0;
  static_cast<void>(recorded([&] {
    sum += strand_->energetics()->power(t, of_strand(q), of_strand(v));
    return Status::ok;
  }));
  static_cast<void>(each_loose([&](BodySystem& body, std::size_t k) {
    sum += body.power(t, of_body(q, k), of_body(v, k));
    return Status::ok;
  }));
  return sum;
}

}  // namespace tress::models
