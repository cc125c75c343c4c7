#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// A clamped strand stands on a plane by its tip, normal to it, and is lowered by eps L
/// after contact: it bows out, and its tip slips away when the plane's friction is less
/// than mu_c(eps) = |H|/P, the ratio of the holding forces.
///
/// The plane is the effect `body`: it yields by 1e-4 L at most, and its friction is
/// regularised, so that a sticking tip creeps, by u < v with (2 - u/v) u/v = mu_c/mu. The
/// slip speed v is 3e-3 L over the time of the run: creep is at most 3e-3 L, while a
/// slipping tip runs out to where the strand is nearly straight, 0.4 L away at eps = 0.1.
/// A threshold of 5 % of L separates the two. The least friction that holds is found by
/// bisection between half and twice mu_c, to 0.5 %.
std::vector<ValidationTest> stick_slip_tests();

}  // namespace tress::experiments::validation
