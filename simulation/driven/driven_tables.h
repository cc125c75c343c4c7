#pragma once

#include <span>
#include <string>
#include <vector>

#include "contract/parameters.h"
#include "simulation/files/toml_text.h"
#include "simulation/table/table.h"

/// Tables of a scene that load or move sections of its strands: [[effects.point_moment]]
/// and [[effects.natural_shape]]. They are no effects of the catalogue, because an effect
/// acts on points.
namespace tress::simulation {

/// One kind of these tables.
struct DrivenKind {
  std::string_view id;                    // below [effects]
  std::string_view summary;               // one line
  std::string_view source;                // author and year
  std::span<const Parameter> parameters;  // its keys
};
/// Returns all kinds.
std::span<const DrivenKind> driven_kinds();
/// Returns true if [effects.`id`] is one of these tables.
bool is_driven(std::string_view id);

/// The tables of a scene, as read.
struct DrivenTables {
  std::vector<Table> moments;  // [[effects.point_moment]]
  std::vector<Table> shapes;   // [[effects.natural_shape]]

  /// Returns true if there are tables.
  bool any() const { return !moments.empty() || !shapes.empty(); }
  /// Returns the first table; there must be one.
  const Table& first() const {
    return moments.empty() ? shapes.front() : moments.front();
  }
};
/// Reads these tables of [effects]. Throws InputError with file:line:column.
DrivenTables read_driven(const toml::table& effects, const std::string& file);

}  // namespace tress::simulation
