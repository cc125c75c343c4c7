#pragma once

#include <span>
#include <string>

#include "models/parameters.h"

namespace tress {

/// Every table and key of a scene with default, range and unit as Markdown: the content
/// of scenes/README.md.
std::string scene_schema();

/// A scene of one strand with every key at its default. What the defaults do not use
/// stands behind a # that no blank follows: other models, a groom, the effects, keys of
/// other shapes and motions.
std::string scene_defaults();

/// The default as a value of TOML.
std::string default_value(const Parameter& parameter);

}  // namespace tress
