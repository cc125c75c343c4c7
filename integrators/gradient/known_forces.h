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

/// Law of the residual in a parameter s, in states and at times that no probe sees.
enum class ParameterLaw {
  unknown,  // It may begin, end or turn anywhere.
  affine,   // If it is affine in s near the start, it is affine in s everywhere.
  smooth    // Affine, with a derivative by s that is analytic in state and time.
};

}  // namespace tress::integrators
