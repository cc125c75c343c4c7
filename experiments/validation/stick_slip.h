#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress {

/// A clamped strand that stands on a plane by its tip, normal to it, and is lowered by
/// eps L after it has touched: it bows out, and its tip slips away when the plane's
/// friction is less than mu_c(eps) = |H|/P, the ratio of the forces that hold it.
///
/// The plane is the effect `body`: it gives way by 1e-4 L at most, and its friction is
/// regularised, so that what should stick creeps, by u < v with (2 - u/v) u/v = mu_c/mu.
/// The slip speed v is 3e-3 L over the time of the run: all that creep can make of it is
/// 3e-3 L, while a tip that slips runs out to where the strand is nearly straight, 0.4 L
/// away at eps = 0.1. 5 % of L tells the two apart. The least friction that holds is
/// found by halving between half and twice mu_c, to 0.5 %.
std::vector<ValidationTest> stick_slip_tests();

/// A clamped strand whose pinned tip stays on the line of the clamp's tangent, at (1 -
/// eps) L from it: theta'' = -(H cos theta + P sin theta)/EI, theta(0) = 0, theta'(L) =
/// 0, in the first buckled shape, eps in (0, 0.4]. Throws std::runtime_error beyond.
///
/// In the frame of the force R, u = theta + atan(H/P), it is a pendulum, u'' = -q^2 sin
/// u with q^2 = R/EI, at rest at the tip: found by integrating from the tip, the length q
/// L from the tip being on the line and the tip's u from eps.
struct PinnedElastica {
  double axial, lateral;  // P, |H| over EI/L^2
  double tip;             // |theta(L)|, rad
};
PinnedElastica pinned_elastica(double eps);

}  // namespace tress
