#pragma once

#include <numbers>

#include "integrators/esdirk.h"

namespace tress::integrators {

namespace tr_bdf2_entries {

/// Diagonal coefficient g/2, g = 2 - sqrt(2).
inline constexpr double d = 1 - std::numbers::sqrt2 / 2;
/// Weight of the first two stages.
inline constexpr double w = std::numbers::sqrt2 / 4;

// Measured on scenes/accuracy with super_helix at thresholds from 1e-2 to 1e-4: the error
// of a run falls as the threshold to the power 0.8 (2/3 in the limit) and was 0.13 to 3.9
// of it. These share and power leave 0.06 to 0.8 of the tolerance.
/// Coefficients of TR-BDF2 and its comparison solution of order 3.
inline constexpr EsdirkTable table{.stages = 3,
                                   .order = 2,
                                   .embedded_order = 3,
                                   .a = {{{}, {d, d}, {w, w, d}}},
                                   .embedded = {(1 - w) / 3, (3 * w + 1) / 3, d / 3},
                                   .share = 1.2,
                                   .power = 1.25};

}  // namespace tr_bdf2_entries

/// Trapezoidal rule to t + g h, then BDF2 to t + h, g = 2 - sqrt 2, for which both solve
/// with the same matrix and the method is L-stable. [Bank et al. 1985, IEEE Trans. CAD 4,
/// 436; as a Runge-Kutta method with its embedded one of order 3: Hosea, Shampine 1996,
/// Appl. Numer. Math. 20, 21, table 1]
constexpr const EsdirkTable& tr_bdf2_table() { return tr_bdf2_entries::table; }

}  // namespace tress::integrators
