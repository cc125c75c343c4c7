#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Where a scene says what can be wrong with it only as a whole.
struct ScenePlaces {
  std::string model, integrator;     // file:line:column of the ids
  std::vector<std::string> strands;  // of each strand's table
  std::vector<std::string> effects;
  std::string interaction;
};

/// Builds once what a run will build: effects, the model on one strand of each table, the
/// integrator. Throws InputError with the place of what refuses.
void check(const Scene& scene, const ScenePlaces& places);

}  // namespace tress::simulation
