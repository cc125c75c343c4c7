#pragma once

#include <cmath>

#include "integrators/catalogue.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Error of a run over its distance from the run with half the steps: 2^p/(2^p - 1) of a
/// method of order p [Richardson 1911].
inline double error_over_change(const Scene& scene) {
  const IntegratorEntry& method = find_integrator(scene.integrator);
  const double ratio = std::pow(2, *method.order(scene.options.formulation));
  return ratio / (ratio - 1);
}

}  // namespace tress::simulation
