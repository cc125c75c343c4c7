#pragma once

#include <span>
#include <string>

#include "contract/layers.h"
#include "contract/parameters.h"

namespace tress::simulation {

/// Every table and key of a scene with default, range and unit as Markdown: the content
/// of scenes/README.md.
std::string scene_schema();

/// A short scene to start from: one strand that swings under gravity, the most commonly
/// changed keys with their ranges, all at their defaults.
std::string scene_defaults();

/// The default as a TOML value.
std::string default_value(const Parameter& parameter);

}  // namespace tress::simulation
