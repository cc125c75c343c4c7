#pragma once

#include <array>

#include "math/gauss_legendre.h"
#include "models/head/helix_strand.h"
#include "models/head/lane_energies.h"

namespace tress::models {

/// Energies of clamped super-helices, side by side, in consistent units. As ReducedSystem
/// has them: mass at the Gauss-Legendre points of the elements, rotors at their ends.
template <class T>
class HelixEnergies {
 public:
  using Vec = Vec3<T>;

  explicit HelixEnergies(int points) : points_(points) {
    std::size_t i = 0;
    for (const QuadraturePoint& p : gauss_legendre(points, 1)) {
      at_[i] = p.at;
      weight_[i++] = p.weight;
    }
  }

  /// `at` and `frame`: of the root. O(elements points).
  LaneEnergies<T> operator()(const HelixMaterial<T>& m, const HelixRoot<T>& root, Vec at,
                             FrameOf<T> frame, const Vec* rest, const Vec* q,
                             const Vec* v, std::size_t elements) const {
    Vec velocity = root.v, omega = root.omega;
    // A joint has the halves of two elements, root and last tip those of one.
    LaneEnergies<T> sum{T(0.25) * m.rotor * omega.x * omega.x, T(0), Vec{},
                        dot(velocity, velocity), at};
    for (std::size_t i = 0; i < elements; ++i) {
      const HelixElement<T> element(q[i], v[i]);
      const LaneFunctions<T> functions(q[i], m.length);
      Vec places;  // mass times place, from the element's start
      T mass(0);
      for (std::size_t k = 0; k < static_cast<std::size_t>(points_); ++k) {
        const T arc = T(at_[k]) * m.length, part = T(weight_[k]) * m.length * m.density;
        const HelixFunctions<T> f = functions.at(arc);
        const Vec x = element.position(arc, f);
        const Vec u = velocity + cross(omega, x) + element.slope(f) * v[i];
        sum.kinetic += T(0.5) * part * dot(u, u);
        places = places + part * x;
        mass += part;
      }
      sum.first = sum.first + mass * at + frame * places;
      const Vec bent = q[i] - rest[i];
      sum.elastic +=
          T(0.5) * (m.stiffness.x * bent.x * bent.x + m.stiffness.y * bent.y * bent.y +
                    m.stiffness.z * bent.z * bent.z);
      const HelixFunctions<T> f = functions.at(m.length);
      const auto turn = element.turn(m.length, f, functions.x2());
      const Vec tip = element.position(m.length, f);
      velocity =
          turn.rotation.back(velocity + cross(omega, tip) + element.slope(f) * v[i]);
      omega = turn.rotation.back(omega + turn.velocity);
      at = at + frame * tip;
      frame = frame * FrameOf<T>{turn.rotation.column(0), turn.rotation.column(1),
                                 turn.rotation.column(2)};
      const T rotor = T(i + 1 < elements ? 0.5 : 0.25) * m.rotor;
      sum.kinetic += rotor * omega.x * omega.x;
      sum.passes(velocity);
    }
    sum.tip = at;
    return sum;
  }

 private:
  int points_;
  std::array<double, HelixStrand<T>::most_points> at_{}, weight_{};
};

}  // namespace tress::models
