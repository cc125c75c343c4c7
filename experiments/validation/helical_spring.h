#pragma once

#include "contract/layers.h"

namespace tress::experiments::validation {

/// A uniform helix of round section pulled along its axis by a force F, free to turn
/// about it [Love 1927, section 271]: radius r, pitch angle a (natural 1 and a_0, lengths
/// in natural radii, forces in EI/r_0^2), GJ/EI = 1/(1 + nu):
///
///     M_b = cos^2 a/r - cos^2 a_0,   M_t = (sin a cos a/r - sin a_0 cos a_0)/(1 + nu),
///     0 = M_t sin a + M_b cos a,     F = (M_t cos a - M_b sin a)/r.
struct PulledHelix {
  double radius, pitch_angle;  // r, a (rad)
};
PulledHelix pulled_helix(double natural_pitch_angle, double poisson_ratio, double force);

}  // namespace tress::experiments::validation
