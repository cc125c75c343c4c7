#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "models/catalogue.h"
#include "simulation/scene/table.h"

namespace tress::simulation {

// What every table of a scene may hold: the reader, the schema page and the scene of
// defaults take it from here.

/// The keys before the first table.
std::span<const Parameter> top_parameters();

/// `id`, and what of the model's parameters no other table of a scene says: its own
/// options, or all of them when it brings its own geometry.
std::span<const Parameter> model_table_parameters(const ModelEntry& model);

/// `id`, `dt_s` and the integrators' options.
std::span<const Parameter> integrator_table_parameters();
/// Which of them go with which integrator only.
std::span<const Use> integrator_uses();

/// The effect that is not one of a single strand.
inline constexpr std::string_view interaction_id = "strand_interaction";

/// A table of a scene, described.
struct TableEntry {
  std::string name;     // "strand"
  std::string summary;  // one line
  std::span<const Parameter> parameters;
  std::string_view choice = {};    // the key whose word decides what others do,
  std::span<const Use> uses = {};  // and which these are
  bool needed = false;             // of a scene of one strand
  bool many = false;               // [[name]]
};

/// All tables but [model], in the order in which a scene is written.
std::vector<TableEntry> table_entries();

}  // namespace tress::simulation
