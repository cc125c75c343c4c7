#pragma once

#include "contract/system.h"

namespace tress {

/// Teleports: times at which the prescribed root of a strand jumps to another pose. An
/// optional capability of systems with a root. The root follows the teleports that were
/// carried out, not the time: stages beyond a teleport see the motion before it go on.
class Teleports {
 public:
  virtual ~Teleports() = default;
  /// Returns the first teleport after t, s; infinity: none.
  virtual double next_teleport(double t) const = 0;
  /// Carries the state just before the teleport at t, and all that the system remembers,
  /// rigidly with the root. From then on the root follows the motion after it.
  virtual void teleport(double t, InOut q, InOut v) = 0;
  /// Follows the motion between the teleports before and after t, at all times. Until the
  /// first call, each time has the motion between its own teleports.
  virtual void follow(double t) = 0;
};

/// Returns the teleports of a system; null if it cannot be carried.
inline Teleports* teleports(System& system) { return dynamic_cast<Teleports*>(&system); }

}  // namespace tress
