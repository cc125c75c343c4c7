#pragma once

#include "contract/system.h"

namespace tress {

/// Accelerations of the points of MaterialPoints, an optional capability of systems.
class PointAccelerations {
 public:
  virtual ~PointAccelerations() = default;
  /// Computes the accelerations of all points at a state (q, v, a), (3 count), m/s^2.
  virtual void accelerations(double t, In q, In v, In a, Out x) = 0;
};

/// Returns the accelerations of a system's points; null if it has none.
inline PointAccelerations* point_accelerations(System& system) {
  return dynamic_cast<PointAccelerations*>(&system);
}

}  // namespace tress
