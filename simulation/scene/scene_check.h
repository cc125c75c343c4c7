#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "contract/forms/natural_strains.h"
#include "contract/input_error.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Locations of the settings that can be checked only together.
struct ScenePlaces {
  std::string model, integrator;                            // file:line:column of the ids
  std::map<std::string, std::string, std::less<>> options;  // of keys in [integrator]
  std::string tolerance;                                    // empty: the step is given
  std::vector<std::string> strands;                         // of each strand's table
  std::vector<std::size_t> numbers;  // of each strand among all of the scene
  std::vector<std::string> effects;  // of each effect's table
  std::string rest, failed_strands;  // of the keys in [simulation]
};

/// Returns what the run lacks for an option of [integrator] to have an effect; empty: it
/// has one. `option`: a name in integrators::common_options().
std::string_view idle_option(const Scene& scene, std::string_view option);

/// Throws an InputError with another place. Its problem names the former one.
[[noreturn]] void refuse_at(const std::string& place, const InputError& error);

/// The natural strains of a system for rest = "inverse". Throws InputError with `where`
/// if it has none, or its strand falls whatever they are.
NaturalStrains& strains_to_hold(const Scene& scene, const Strand& strand, System& system,
                                const std::string& where);

/// Constructs once what a run will construct: effects, the model on one strand of each
/// table, the integrator. Throws InputError with the location of what fails. `strands`:
/// number of all strands of the scene.
void check(const Scene& scene, const ScenePlaces& places, std::size_t strands);

}  // namespace tress::simulation
