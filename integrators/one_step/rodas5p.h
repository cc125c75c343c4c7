#pragma once

#include "integrators/one_step/rosenbrock.h"

namespace tress::integrators {

/// Rodas5P: eight stages, order 5, embedded order 4, L-stable, for systems of index 1.
/// [Steinebach 2023, BIT 63, 27; coefficients as in OrdinaryDiffEq.jl]
const RosenbrockTable& rodas5p_table();

}  // namespace tress::integrators
