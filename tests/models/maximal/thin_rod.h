#pragma once

#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

/// L = 1 m, EI = 1 N m^2, 0.1 pi kg/m, GJ/EI = 1/1.4. EA L^2/EI = 4/r^2 = 4e6: weights of
/// Gamma <= 100 stretch it by Gamma/4e6.
inline const ModelSettings thin_rod = {{"length_m", "1"},
                                       {"radius_m", "0.001"},
                                       {"density_kg_m3", "100000"},
                                       {"youngs_modulus_pa", "1273239544735.1627"},
                                       {"poisson_ratio", "0.4"}};
/// Rounding of stretch forces, eps EA, bends it by eps EA L^2/EI.
inline constexpr double thin_rod_accuracy = 2.2e-16 * 4e6;

}  // namespace tress::testing_support
