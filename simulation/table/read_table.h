#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/files/toml_text.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// Reads a scene's table with `declared` parameters. A number is a TOML number, an option
/// value or a text a string (or true, false). Components are a list of numbers, rows a
/// list of such lists, or a string: a file with a row in each line (rows_file.h). The
/// text of a parameter whose name ends in file is a path relative
/// to the scene's folder. Keys in `nested` are left to the caller. Throws InputError with
/// file:line:column, naming the nearest key if there is one.
Table read_table(const toml::table& table, std::span<const Parameter> declared,
                 const std::string& name, const std::string& file,
                 std::span<const std::string_view> nested = {});

/// Sets this key in `read` if the table has the key.
void read_key(const toml::table& table, std::string_view key, const std::string& file,
              Table& read);

/// Returns the columns of rows of `count` numbers.
template <std::size_t count>
std::array<std::vector<double>, count> columns(std::span<const double> rows) {
  std::array<std::vector<double>, count> all;
  for (std::size_t i = 0; i < rows.size(); ++i) all[i % count].push_back(rows[i]);
  return all;
}

/// Returns [name] as one table, [[name]] as all of them. Throws InputError if several are
/// given and not `many` are admitted.
std::vector<const toml::table*> tables_of(const toml::node& node, const std::string& name,
                                          bool many, const std::string& file);

/// Throws InputError unless the node is a table.
const toml::table& as_table(const toml::node& node, const std::string& name,
                            const std::string& file);

}  // namespace tress::simulation
