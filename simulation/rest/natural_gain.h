#pragma once

#include <vector>

#include "simulation/rest/dense_statics.h"

namespace tress::simulation {

/// Location of errors of rest = "inverse" that have no place in a file.
inline constexpr const char* inverse_rest = "rest = \"inverse\"";

/// Returns the coordinates of the initial state.
std::vector<double> coordinates_at_start(const System& system);

/// The changes of natural strains that answer a residual: for strains that are
/// coordinates exactly, else so that the least displacement remains (held_shape.h).
Eigen::MatrixXd natural_gain(DenseStatics& statics, NaturalStrains& strains);

}  // namespace tress::simulation
