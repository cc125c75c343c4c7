#pragma once

#include <cstddef>

#include "contract/system.h"

namespace tress {

/// Forces of the joints that connect points of strands, an optional capability of
/// systems.
class JointForces {
 public:
  virtual ~JointForces() = default;
  /// Returns the number of joints; fixed for life.
  virtual std::size_t joints() const = 0;
  /// Computes the force (N) and the moment (N m) that the first end of each joint exerts
  /// on the second, (3 joints) each, world components. The moment is about the point of
  /// the second end. Constraints contribute the multipliers of g'' = 0 at this state.
  virtual Status joint_forces(double t, In q, In v, Out forces, Out moments) = 0;
};

/// Returns the joint forces of a system; null if it has no joints.
inline JointForces* joint_forces(System& system) {
  return dynamic_cast<JointForces*>(&system);
}

}  // namespace tress
