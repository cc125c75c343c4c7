#pragma once

#include "contract/system.h"

namespace tress::experiments {

/// Small undamped motions about a state of rest q, x'' = -M^-1 K x with K = dr/dq: x ~
/// exp(s t), s^2 = -(eigenvalues of M^-1 K). Those of a symmetric M and K that are
/// positive definite are positive; other equations may have any.
struct LinearModes {
  double slowest_rad_s = 0;  // least |s|
  double growth_1_s = 0;     // largest real part of s: 0 where nothing grows
  int complex_modes = 0;     // eigenvalues that are not real
};

/// For models without constraints whose M is regular, whatever its symmetry. O(n^3).
LinearModes linear_modes(System& system, In q);

}  // namespace tress::experiments
