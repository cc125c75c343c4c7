#pragma once

#include <string>
#include <string_view>

#include "contract/parameters.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// The scene as a file: reading it gives the same scene to the last bit. What has its
/// default is left out, and files that it names are named by their full paths, so that it
/// may lie in any folder. Throws std::logic_error where no table says the strands (see
/// Scene::tables).
std::string scene_text(const Scene& scene);

/// A value as a scene has it, from the text that Parameters::set takes.
std::string toml_value(const Parameter& parameter, std::string_view text);

}  // namespace tress::simulation
