#pragma once

#include <cstddef>

#include "contract/system.h"
#include "math/vec3.h"

namespace tress {

/// Work of natural strains that move over a step, at the places of its start and of its
/// end, J. The mean of both is exact where strains move linearly.
struct NaturalWork {
  double at_start = 0, at_end = 0;  // at the places of the start, of the end
};

/// Forces of the supports that hold points of a strand, an optional capability of
/// systems.
class SupportForces {
 public:
  virtual ~SupportForces() = default;
  /// Returns the number of supports; fixed for life.
  virtual std::size_t supports() const = 0;
  /// Computes the force (N) and the moment about the held point (N m) that each support
  /// exerts on the strand, (3 supports) each, world components. They keep points and
  /// sections on their paths at this state, and are the multipliers of g'' = 0.
  virtual Status support_forces(double t, In q, In v, Out forces, Out moments) = 0;
  /// Writes the places (m), the velocities (m/s) and the angular velocities (rad/s) of
  /// the supports, (3 supports) each.
  virtual void support_motion(double t, Out x, Out u, Out omega) const = 0;
  /// Computes the power (W) of moments on sections, seen from a frame that turns with the
  /// angular velocity `turning` (rad/s).
  virtual double moment_power(double t, In q, In v, const Vec& turning) = 0;
  /// Returns true if natural strains move in some interval.
  virtual bool natural_moves() const = 0;
  /// Computes the power (W) of natural strains that move. It is part of
  /// Energetics::power.
  virtual double natural_power(double t, In q) = 0;
  /// Computes the work of natural strains that move over a step from one state to
  /// another.
  virtual NaturalWork natural_work(double from, In q_from, double to, In q_to) = 0;
};

/// Returns the support forces of a system; null if it has no supports.
inline SupportForces* support_forces(System& system) {
  return dynamic_cast<SupportForces*>(&system);
}

}  // namespace tress
