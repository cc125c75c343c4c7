#pragma once

#include "contract/layers.h"

namespace tress::experiments::validation {

/// Returns omega of the `mode`-th transverse vibration of a hanging rod of weight Gamma =
/// rho g S L^3/EI (Gamma < 0: standing), clamped at its upper end. The unit is
/// sqrt(EI/(rho S L^4)):
///
///     w'''' = Gamma (x w')' + omega^2 w,   x from the free tip, where w'' = w''' = 0,
///     w = w' = 0 at x = 1,
///
/// by its second compound equations (the 2 x 2 minors of the two solutions from the tip,
/// which avoid the cancellation of the solutions themselves). Gamma = 0: a beam [Rayleigh
/// 1877]; Gamma large: a heavy chain. Accuracy 1e-11 for |Gamma| <= 1e5, mode <= 10.
/// Throws InputError otherwise and for a rod that does not stand (Gamma < -7.837).
double heavy_rod_mode(double gamma, int mode);

/// Returns omega of the `mode`-th vibration in the plane of a rod, in the same unit. The
/// rod is naturally an arc of angle `opening` (rad), clamped at one end. The tangential
/// and normal displacements are u and w, and the tangent turns by theta. The moment over
/// EI/L is M, and the components of the force over EI/L^2 are T and N. The linearised
/// equations of an inextensible rod of curvature k = opening are
///
///     u' = k w,   w' = theta - k u,   theta' = M,
///     M' = -N,   T' = k N - omega^2 u,   N' = -k T - omega^2 w,
///
/// u = w = theta = 0 at the clamp and M = T = N = 0 at the tip. Accuracy 1e-10 for modes
/// <= 5.
double curved_beam_mode(double opening, int mode);

}  // namespace tress::experiments::validation
