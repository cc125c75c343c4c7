#pragma once

#include <toml++/toml.h>

#include <string>

#include "contract/layers.h"

namespace tress::simulation {

/// file:line:column of the start of `source`.
std::string place_of(const toml::source_region& source, const std::string& file);

/// Of a TOML file for any of our programs; the rest of a larger one is not read.
constexpr std::size_t most_toml_bytes = 4 << 20;

/// Throws InputError with file:line:column on NUL bytes, malformed TOML and more than 100
/// levels; `file` is the name of the text in messages.
toml::table parse_toml(const std::string& text, const std::string& file);

/// Text of a scalar as `--set` would give it, numbers so that reading them gives the same
/// ones; empty when it is not a scalar (a date, a list, a table).
std::string scalar_text(const toml::node& node);

}  // namespace tress::simulation
