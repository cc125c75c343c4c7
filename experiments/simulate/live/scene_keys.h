#pragma once

#include <toml++/toml.h>

#include <nlohmann/json.hpp>
#include <string>

#include "contract/layers.h"

namespace tress::experiments::scene_runs {

/// Returns the numbers and lists of numbers of a scene, by their paths
/// "effects.wind.velocity_m_s"; numbers in a path count the tables of one name from 0.
/// Includes the keys that a table of the scene leaves at their defaults.
nlohmann::json scene_keys(const toml::table& scene);

/// Sets the value at a path, a number, a word or a list of numbers. Throws InputError if
/// a table of the path is not there.
void set_key(toml::table& scene, const std::string& path, const nlohmann::json& value);

}  // namespace tress::experiments::scene_runs
