#pragma once

namespace tress::integrators {

/// Properties of the forces in a system.
struct KnownForces {
  /// Whether the SparseForm is all of dr/dv, which it is not where effects couple distant
  /// points.
  bool sparse = true;
  /// Whether they are inertia, elasticity and viscous drag alone, which are at most
  /// quadratic in velocities at fixed q. Others, such as contact, may turn within short
  /// distances.
  bool quadratic = false;
};

}  // namespace tress::integrators
