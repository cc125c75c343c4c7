#pragma once

#include <string>
#include <string_view>

#include "contract/parameters.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// The scene as a file; reading it restores the scene bit for bit. Defaults are omitted,
/// and files are named by their full paths, so that the scene can be put in any folder.
/// Throws std::logic_error if no table describes the strands (see Scene::tables).
std::string scene_text(const Scene& scene);

/// A TOML value from the text that Parameters::set accepts.
std::string toml_value(const Parameter& parameter, std::string_view text);

}  // namespace tress::simulation
