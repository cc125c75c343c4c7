#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Locations of the settings that can be checked only together.
struct ScenePlaces {
  std::string model, integrator;     // file:line:column of the ids
  std::string tolerance;             // empty: the step is given
  std::vector<std::string> strands;  // of each strand's table
  std::vector<std::string> effects;
};

/// Constructs once what a run will construct: effects, the model on one strand of each
/// table, the integrator. Throws InputError with the location of what fails.
void check(const Scene& scene, const ScenePlaces& places);

}  // namespace tress::simulation
