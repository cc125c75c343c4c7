#pragma once

#include "contract/layers.h"

namespace tress::experiments::validation {

/// Returns the threshold at which the tip of a naturally curved strand curls out of its
/// plane. The strand is clamped with its tangent down and its natural shape is an arc of
/// angle phi in a plane [Miller, Lazarus, Audoly & Reis 2014; Romero et al. 2021]. Under
/// a large weight it hangs in that plane. With decreasing weight this becomes unstable at
/// Gamma = rho g S L^3/EI. The result is Gamma^(1/3)/phi = 1/(kappa_n L_gb). For long
/// strands 0.6206885 (Poisson's ratio nu = 0.5).
///
/// With theta the angle from down, k = theta', M = k - phi, over EI/L and EI/L^2:
///
///     theta'' = Gamma (1 - s) sin theta,   theta(0) = 0,   M(1) = 0.
///
/// Under rotation by alpha t + beta n (t tangent, n normal in the plane) moments change
/// by X t + Y n. With GJ/EI = 1/(1 + nu) and the weight below, F = Gamma (1 - s) down,
///
///     X = (alpha' - k beta)/(1 + nu) + M beta,   X' = k Y - beta F.n,
///     Y = beta' + k alpha - M alpha,             Y' = -k X + beta F.t;
///
/// at the threshold there is a solution with alpha = beta = 0 at the clamp, X = Y = 0 at
/// the tip. Accuracy 1e-6, for nu in [0.3, 0.5] and phi up to 6 pi. Below about nu = 0.3
/// the tip points up at the threshold, which the shooting does not follow. Throws
/// InputError otherwise, and where strands of this phi are stable at any weight (below
/// 1.8 pi at nu = 0.5).
double curl_threshold(double phi, double poisson_ratio);

/// Uniform helix of round section pulled along its axis by a force F, free to turn about
/// it [Love 1927, section 271]. Radius r and pitch angle a (natural 1 and a_0), lengths
/// in natural radii, forces in EI/r_0^2, GJ/EI = 1/(1 + nu):
///
///     M_b = cos^2 a/r - cos^2 a_0,   M_t = (sin a cos a/r - sin a_0 cos a_0)/(1 + nu),
///     0 = M_t sin a + M_b cos a,     F = (M_t cos a - M_b sin a)/r.
struct PulledHelix {
  double radius, pitch_angle;  // r, a (rad)
};
PulledHelix pulled_helix(double natural_pitch_angle, double poisson_ratio, double force);

/// Clamped strand whose pinned tip stays on the line of the clamp's tangent, at (1 - eps)
/// L from it, in the first buckled shape. The angle satisfies theta'' = -(H cos theta + P
/// sin theta)/EI, theta(0) = 0 and theta'(L) = 0, with eps in [1e-4, 0.8]. Throws
/// std::runtime_error otherwise.
///
/// In the frame of the force R, u = theta + atan(H/P), it is a pendulum, u'' = -q^2 sin u
/// with q^2 = R/EI, at rest at the tip. It is solved by integration from the tip. q L
/// follows from the tip being on the line, the tip's u from eps.
struct PinnedElastica {
  double axial, lateral;  // P, |H| over EI/L^2
  double tip;             // |theta(L)|, rad
};
PinnedElastica pinned_elastica(double eps);

}  // namespace tress::experiments::validation
