#pragma once

#include "tests/models/reduced/kirchhoff.h"

namespace tress::testing_support {

using namespace simulation;

/// The unit rod (kirchhoff.h) as extensible models take it: EA L^2/EI = 4/r^2 = 4e6, so
/// weights of Gamma <= 100 stretch it by Gamma/4e6.
inline const ModelSettings thin_rod = {{"length_m", "1"},
                                       {"radius_m", "0.001"},
                                       {"density_kg_m3", "100000"},
                                       {"youngs_modulus_pa", "1273239544735.1627"},
                                       {"poisson_ratio", "0.4"}};
/// Accuracy at which it rests: rounding of stretch forces, eps EA, bends it by eps EA
/// L^2/EI.
inline constexpr double at_rest = 2.2e-16 * 4e6;

}  // namespace tress::testing_support
