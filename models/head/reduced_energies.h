#pragma once

#include "models/head/lane_energies.h"
#include "models/head/reduced_kernel.h"

namespace tress::models {

/// Energies of clamped strands in SIMD lanes, in consistent units, with the
/// discretisation of ReducedSystem: mass at the Gauss-Legendre points of the elements,
/// rotors at their ends. Kind: see models/head/reduced_kernel.h.
template <class Kind>
class ReducedEnergies {
  using T = typename Kind::Real;
  using Vec = Vec3<T>;

 public:
  /// Uses the points of a kernel, which must outlive it.
  explicit ReducedEnergies(const ReducedKernel<Kind>& kernel) : kernel_(kernel) {}

  /// Returns the energies at (q, v). `at` and `frame`: position and frame of the root;
  /// `rest(i)`: unknowns of element i at rest. O(elements points).
  template <class Rest>
  LaneEnergies<T> operator()(const ReducedMaterial<T>& m, const ReducedMotion<T>& root,
                             Vec at, FrameOf<T> frame, Rest rest,
                             const typename Kind::Unknowns* q,
                             const typename Kind::Unknowns* v) const {
    Vec velocity = root.v, omega = root.omega;
    LaneEnergies<T> sum{T(0.5 * Kind::rotors_of_root) * m.rotor * omega.x * omega.x, T(0),
                        Vec{}, dot(velocity, velocity), at};
    const int elements = kernel_.elements();
    for (int i = 0; i < elements; ++i) {
      const typename Kind::Shape shape(kernel_.rule(), q[i], v[i], m.length);
      Vec places;  // mass times place, from the element's start
      T mass(0);
      for (int k = 0; k < kernel_.points(); ++k) {
        const T part = T(kernel_.weight(k)) * m.length * m.density;
        const SeenPoint<T> point = shape.at(kernel_.place(k, m.length));
        const Vec u = velocity + cross(omega, point.position) + point.velocity;
        sum.kinetic += T(0.5) * part * dot(u, u);
        places = places + part * point.position;
        mass += part;
      }
      sum.first = sum.first + mass * at + frame * places;
      const typename Kind::Unknowns bent = q[i] - rest(i);
      if constexpr (std::same_as<typename Kind::Unknowns, Vec>) {
        sum.elastic +=
            T(i == 0 ? 0.5 * Kind::first_stiffness : 0.5) *
            (m.stiffness.x * bent.x * bent.x + m.stiffness.y * bent.y * bent.y +
             m.stiffness.z * bent.z * bent.z);
      } else {
        Kind::add_energies(m, bent, v[i], sum.elastic, sum.kinetic);
      }
      const SeenTip<T> tip = shape.tip();
      velocity = tip.rotation.back(velocity + cross(omega, tip.position) + tip.velocity);
      omega = tip.rotation.back(omega + tip.turning);
      at = at + frame * tip.position;
      frame = frame * FrameOf<T>{tip.rotation.column(0), tip.rotation.column(1),
                                 tip.rotation.column(2)};
      const T rotor = T(i + 1 < elements ? 0.5 : 0.5 * Kind::rotors_of_last) * m.rotor;
      sum.kinetic += rotor * omega.x * omega.x;
      sum.passes(velocity);
    }
    sum.tip = at;
    return sum;
  }

 private:
  const ReducedKernel<Kind>& kernel_;
};

}  // namespace tress::models
