#pragma once

#include "integrators/esdirk.h"

namespace tress::integrators {

/// Trapezoidal rule to t + g h, then BDF2 to t + h, g = 2 - sqrt 2, for which both solve
/// with the same matrix and the method is L-stable. [Bank et al. 1985, IEEE Trans. CAD 4,
/// 436; as a Runge-Kutta method with its embedded one of order 3: Hosea, Shampine 1996,
/// Appl. Numer. Math. 20, 21, table 1]
const EsdirkTable& tr_bdf2_table();

}  // namespace tress::integrators
