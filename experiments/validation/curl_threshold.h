#pragma once

#include "contract/layers.h"

namespace tress::experiments::validation {

/// A strand clamped with its tangent down whose natural shape is an arc of angle phi in a
/// plane [Miller, Lazarus, Audoly & Reis 2014; Romero et al. 2021]: under a large weight
/// it hangs in that plane. Returns Gamma^(1/3)/phi = 1/(kappa_n L_gb) at the Gamma = rho
/// g S L^3/EI where, with decreasing weight, this becomes unstable and the tip curls out
/// of the plane. For long strands 0.6206885 (Poisson's ratio nu = 0.5).
///
/// With theta the angle from down, k = theta', M = k - phi, over EI/L and EI/L^2:
///
///     theta'' = Gamma (1 - s) sin theta,   theta(0) = 0,   M(1) = 0.
///
/// Under rotation by alpha t + beta n (t tangent, n normal in the plane) moments change
/// by X t + Y n, and with GJ/EI = 1/(1 + nu) and the weight below, F = Gamma (1 - s)
/// down,
///
///     X = (alpha' - k beta)/(1 + nu) + M beta,   X' = k Y - beta F.n,
///     Y = beta' + k alpha - M alpha,             Y' = -k X + beta F.t;
///
/// at the threshold there is a solution with alpha = beta = 0 at the clamp, X = Y = 0 at
/// the tip. Accuracy 1e-6, for nu in [0.3, 0.5] and phi up to 6 pi; below about nu = 0.3
/// the tip points up at the threshold, which the shooting does not follow. Throws
/// InputError otherwise, and where strands of this phi are stable at any weight (below
/// 1.8 pi at nu = 0.5).
double curl_threshold(double phi, double poisson_ratio);

}  // namespace tress::experiments::validation
