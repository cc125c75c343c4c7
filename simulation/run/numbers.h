#pragma once

#include <string_view>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Dimensionless numbers of the first strand that decide which effects matter.
struct ScaleNumbers {
  double gravito_bending;  // rho g S L^3/(EI), g of the scene's uniform accelerations
  double inertia_bending;  // rho a S L^3/(EI), a the rms acceleration of the root
  double twist_bending;    // GJ/(EI)
};
/// Computes the numbers of the scene's first strand.
ScaleNumbers scale_numbers(const Scene& scene);

/// Load of one of the scene's effects, rms over all points at all frames of a run, over
/// the weight at 9.81 m/s^2; NaN when there is no such effect.
double load_over_weight(const Scene& scene, std::string_view effect);

}  // namespace tress::simulation
