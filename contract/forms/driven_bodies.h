#pragma once

#include <cstddef>

#include "contract/system.h"
#include "math/frame.h"

namespace tress {

/// Bodies that strands drive, an optional capability of systems. A body turns about a
/// fixed axis or moves freely in space.
class DrivenBodies {
 public:
  virtual ~DrivenBodies() = default;
  /// Motion of a body.
  struct Motion {
    Vec x;             // of its reference point: the pivot or the centre of mass, m
    Frame turn;        // rotation since the start
    Vec v;             // velocity of the reference point, m/s
    Vec omega;         // angular velocity, rad/s
    double angle = 0;  // of a body that turns about an axis, rad
    double speed = 0;  // rate of the angle, rad/s
  };
  /// Energy of all bodies.
  struct OfBodies {
    double kinetic = 0;       // J
    double potential = 0;     // J, of their weight
    double rate = 0;          // W, of the sum of both
    double from_strands = 0;  // W, the part of the rate by contact and supports
  };
  /// Returns the number of bodies; fixed for life.
  virtual std::size_t bodies() const = 0;
  /// Returns the motion of a body at a state.
  virtual Motion motion(In q, In v, std::size_t body) const = 0;
  /// Returns the energy of all bodies at a state, and its rate.
  virtual OfBodies energy_of_bodies(double t, In q, In v) = 0;
  /// Returns the sum of the masses of free bodies times their places, kg m.
  virtual Vec mass_moment(In q) const = 0;
};

/// Returns the driven bodies of a system; null if it has none.
inline const DrivenBodies* driven_bodies(const System& system) {
  return dynamic_cast<const DrivenBodies*>(&system);
}
/// Returns the driven bodies of a system; null if it has none.
inline DrivenBodies* driven_bodies(System& system) {
  return dynamic_cast<DrivenBodies*>(&system);
}

}  // namespace tress
