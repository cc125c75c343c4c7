#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// Tests of the spring experiment: a curly strand, a slender helix of radius r and pitch
/// angle a about a vertical axis, hangs from a clamp and bounces.
///
/// The reference is Love's spring [Love, Treatise, section 271] as a bar that stretches
/// by u and turns by phi about its axis. Let p = sin a + u' and w = cos a/r + phi' per
/// length of wire. Curvature and twist are (w sqrt(1 - p^2), w p), so that small motions
/// obey
///
///     m u_tt = D_11 u'' + D_12 phi'',    m r^2 phi_tt = D_12 u'' + D_22 phi'',
///     D = J^T diag(EI, GJ) J,    J = d(curvature, twist)/d(p, w),
///
/// with m the mass per length of wire. These are two waves of speeds c_1, c_2, which both
/// turn and stretch. Clamped above and free below their first modes are (pi/2)
/// c_k/(length of wire). For flat turns D_11 = GJ/r^2, and the stretching wave has omega
/// = (pi/2) sqrt(k/m). Here k = GJ/(r^2 wire) is Love's stiffness [G d^4/(8 D^3 n)], and
/// m is the mass of the wire. The effective mass is 4 m/pi^2 rather than the m/3 of a
/// spring under a heavy weight.
std::vector<ValidationTest> spring_tests();

/// First frequencies (rad/s) of the two waves of the test's spring.
struct SpringModes {
  double low, high;
};
SpringModes spring_modes(double turns);

}  // namespace tress::experiments::validation
