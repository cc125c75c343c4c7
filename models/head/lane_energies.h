#pragma once

#include "math/lanes.h"
#include "models/head/head.h"
#include "models/head/head_units.h"

namespace tress::models {

/// Energies of strands side by side, in a head's units.
template <class T>
struct LaneEnergies {
  T kinetic, elastic;  // energies of the lanes
  Vec3<T> first;       // mass times place, seen from the head's position
  T fastest;           // largest speed of a point, squared
  Vec3<T> tip;         // place of the last one, seen from there

  /// Takes the speed of a point into `fastest`.
  void passes(const Vec3<T>& velocity) {
    const T speed = dot(velocity, velocity);
    for (int lane = 0; lane < T::lanes; ++lane) {
      if (lane_of(speed, lane) > lane_of(fastest, lane)) {
        set_lane(fastest, lane, lane_of(speed, lane));
      }
    }
  }

  /// In SI, of a strand of so much mass (kg) on a head at `from` (m).
  HeadEnergy of(int lane, const HeadUnits& units, double mass, const Vec& from,
                const Vec& gravity) const {
    const double unit = units.force() * units.length;
    const Vec moment = mass * from + units.mass() * units.length * lane_of(first, lane);
    return {unit * lane_of(kinetic, lane),
            unit * lane_of(elastic, lane),
            -dot(gravity, moment),
            units.speed() * std::sqrt(lane_of(fastest, lane)),
            from + units.length * lane_of(tip, lane),
            mass};
  }
};

}  // namespace tress::models
