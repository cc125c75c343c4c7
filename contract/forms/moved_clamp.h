#pragma once

#include "contract/system.h"

namespace tress {

/// The derivative of a residual by the motion of the clamp, an optional form of systems
/// with a TransposedForm.
class MovedClamp {
 public:
  virtual ~MovedClamp() = default;
  /// Returns the product of the TransposedForm's mu with a change of the residual, W:
  /// that by the clamp's motion of `other` in place of this system's, to first order.
  /// NaN: `other` is another kind of system, or the root is free.
  virtual double power_of_clamp(System& other) noexcept = 0;
};

/// Null if the system has none.
inline MovedClamp* moved_clamp(System& system) {
  return dynamic_cast<MovedClamp*>(&system);
}

}  // namespace tress
