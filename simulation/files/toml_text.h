#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// file:line:column of the start of `source`.
std::string place_of(const toml::source_region& source, const std::string& file);
/// file:line:column of the key "table.key" of a file; of its table if it does not give
/// the key, and the file alone if it gives neither.
std::string place_of_key(const toml::table& root, std::string_view key,
                         const std::string& file);

/// Size limit of a TOML file; the rest of a larger one is not read.
constexpr std::size_t most_toml_bytes = 4 << 20;

/// Throws InputError with file:line:column on NUL bytes, malformed TOML or more than 100
/// levels; `file` names the text in messages.
toml::table parse_toml(const std::string& text, const std::string& file);

/// Text of a scalar in the form of `--set`, with numbers that read back exactly; empty
/// when it is not a scalar (a date, a list, a table).
std::string scalar_text(const toml::node& node);

}  // namespace tress::simulation
