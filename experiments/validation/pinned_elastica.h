#pragma once

#include "contract/layers.h"

namespace tress::experiments::validation {

/// A clamped strand whose pinned tip stays on the line of the clamp's tangent, at (1 -
/// eps) L from it: theta'' = -(H cos theta + P sin theta)/EI, theta(0) = 0, theta'(L) =
/// 0, in the first buckled shape, eps in [1e-4, 0.8]. Throws std::runtime_error
/// otherwise.
///
/// In the frame of the force R, u = theta + atan(H/P), it is a pendulum, u'' = -q^2 sin u
/// with q^2 = R/EI, at rest at the tip: solved by integration from the tip; q L follows
/// from the tip being on the line, the tip's u from eps.
struct PinnedElastica {
  double axial, lateral;  // P, |H| over EI/L^2
  double tip;             // |theta(L)|, rad
};
PinnedElastica pinned_elastica(double eps);

}  // namespace tress::experiments::validation
