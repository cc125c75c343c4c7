#pragma once

#include <string>

#include "contract/forms/history.h"
#include "contract/system.h"

namespace tress {

/// A History that can express a motion of the past in its present coordinates, and that
/// knows jumps of its forces; an optional capability.
class MovingHistory : public History {
 public:
  /// Expresses a motion (q, v, a) at time t, given in the coordinates before the last
  /// accept(), in the present coordinates. False: multistep methods must restart.
  virtual bool carry(double t, InOut q, InOut v, InOut a) const = 0;
  /// Why the motion since reset() has not been smooth, so that neither orders nor
  /// tolerances hold. Empty: no such event was seen.
  virtual std::string not_smooth() const = 0;
};

/// False: the history of `system` cannot.
inline bool carry(System& system, double t, InOut q, InOut v, InOut a) {
  const auto* moving = dynamic_cast<const MovingHistory*>(system.history());
  return moving != nullptr && moving->carry(t, q, v, a);
}

/// Empty also where it is not known.
inline std::string not_smooth(System& system) {
  const auto* moving = dynamic_cast<const MovingHistory*>(system.history());
  return moving == nullptr ? std::string() : moving->not_smooth();
}

}  // namespace tress
