#pragma once

#include <cstddef>

#include "contract/system.h"

namespace tress {

/// Bodies that strands turn about fixed axes, an optional capability of systems.
class TurningBodies {
 public:
  virtual ~TurningBodies() = default;
  /// Motion of a body.
  struct Turn {
    double angle = 0;  // rad
    double speed = 0;  // rad/s
  };
  /// Energy of all bodies.
  struct OfBodies {
    double kinetic = 0;       // J
    double rate = 0;          // W, what strands, bearings and prescribed moments put in
    double from_strands = 0;  // W, the strands' part of it
  };
  /// Returns the number of bodies; fixed for life.
  virtual std::size_t bodies() const = 0;
  /// Returns the motion of a body at a state.
  virtual Turn turn(In q, In v, std::size_t body) const = 0;
  /// Returns the kinetic energy of all bodies at a state, and its rate.
  virtual OfBodies energy_of_bodies(double t, In q, In v) = 0;
};

/// Returns the turning bodies of a system; null if it has none.
inline const TurningBodies* turning_bodies(const System& system) {
  return dynamic_cast<const TurningBodies*>(&system);
}
/// Returns the turning bodies of a system; null if it has none.
inline TurningBodies* turning_bodies(System& system) {
  return dynamic_cast<TurningBodies*>(&system);
}

}  // namespace tress
