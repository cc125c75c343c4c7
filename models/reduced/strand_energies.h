#pragma once

#include "models/reduced/kinematics.h"

namespace tress::models {

/// Energies of a strand without those of its effects, J.
template <class Real>
struct StrandEnergies {
  Real kinetic{0}, elastic{0};  // kinetic and elastic energy, J
};

/// Returns the kinetic energy (J) of a frame that spins about its e0.
template <class Real>
Real rotor_energy(const Real& inertia, const FrameMotionOf<Real>& m) {
  return Real(0.5) * inertia * m.omega.x * m.omega.x;
}

/// Computes the energies at (q, v), to which Kinematics have moved.
template <class Kernel, int modes>
StrandEnergies<typename Kernel::Real> strand_energies(
    const Kinematics<Kernel, modes>& kinematics, std::span<const typename Kernel::Real> q,
    std::span<const typename Kernel::Real> v) {
  using K = Kinematics<Kernel, modes>;
  using Real = typename K::Real;
  const Real half(0.5);
  StrandEnergies<Real> e;
  e.kinetic = rotor_energy(kinematics.root_rotor(), kinematics.root());
  for (std::size_t i = 0; i < kinematics.segments().size(); ++i) {
    const auto& segment = kinematics.segments()[i];
    for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
      const Vec3<Pack> u = kinematics.velocity(i, b);
      e.kinetic += half * sum_over<Real>(kinematics.blocks()[b].mass * dot(u, u));
    }
    e.kinetic += rotor_energy(segment.rotor, kinematics.motion(i).tip);
    if constexpr (Kernel::functions == 2) {
      e.kinetic += half * weighed_square(segment.inertia, K::components(v, i));
    }
    e.elastic +=
        half * weighed_square(segment.stiffness, K::components(q, i) - segment.rest);
  }
  return e;
}

}  // namespace tress::models
