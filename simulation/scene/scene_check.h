#pragma once

#include <string>
#include <vector>

#include "contract/forms/natural_strains.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Locations of the settings that can be checked only together.
struct ScenePlaces {
  std::string model, integrator;     // file:line:column of the ids
  std::string tolerance;             // empty: the step is given
  std::vector<std::string> strands;  // of each strand's table
  std::vector<std::size_t> numbers;  // of each strand among all of the scene
  std::vector<std::string> effects;  // of each effect's table
  std::string rest, failed_strands;  // of the keys in [simulation]
};

/// The natural strains of a system for rest = "inverse". Throws InputError with `where`
/// if it has none, or its strand falls whatever they are.
NaturalStrains& strains_to_hold(const Scene& scene, const Strand& strand, System& system,
                                const std::string& where);

/// Constructs once what a run will construct: effects, the model on one strand of each
/// table, the integrator. Throws InputError with the location of what fails. `strands`:
/// number of all strands of the scene.
void check(const Scene& scene, const ScenePlaces& places, std::size_t strands);

}  // namespace tress::simulation
