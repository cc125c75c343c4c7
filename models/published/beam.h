#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "contract/system.h"

namespace tress::models {

/// The Beam problem: an inextensible elastic rod (length 1 m, mass 1 kg/m, bending
/// stiffness 1 N m^2) of n straight segments, clamped at one end, loaded at the free end
/// by the dead force F(t) = load sin^2 t (-1, 1) N until t = pi, then free. Coordinates:
/// the segments' angles theta (n, rad). With e_l = (cos, sin) theta_l, e'_l its quarter
/// turn, s = 1/n, and the mass lumped at the joints (half at the tip):
///
///     r_l = s e'_l . N_l + dV/dtheta_l,   N_l = sum_{joints m >= l} mass_m z_m - F
///     z_m = s sum_{k <= m} (a_k e'_k - v_k^2 e_k)
///     V = (2 theta_1^2 + sum dtheta^2)/(2 s)
///
/// M is symmetric positive definite, dense, never formed: residual and acceleration are
/// sweeps, and S(w) is solved exactly with the N_l as extra unknowns, a band of
/// half-width 3 in 3n. Every call is O(n). Stiff: the fastest mode has about 4 n^2 rad/s.
///
/// Source: Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.1 eqs.
/// (1.9)-(1.23); Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem
/// "beam" (n = 40, end values at t = 5 s in references.h). Differences here: residual in
/// N m (theirs times n^-3), and the sweeps above in place of the matrices C and D.
std::span<const Parameter> beam_parameters();
std::unique_ptr<System> make_beam(const Parameters& parameters);

}  // namespace tress::models
