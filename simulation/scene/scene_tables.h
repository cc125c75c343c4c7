#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "models/catalogue.h"
#include "simulation/table/table.h"

namespace tress::simulation {

// Contents of all tables of a scene, as used by the reader, the schema page and the scene
// of defaults.

/// The keys before the first table.
std::span<const Parameter> top_parameters();

/// `id` and the model's options.
std::span<const Parameter> model_table_parameters(const ModelEntry& model);

/// `id` and the integrators' options, those in seconds as dt_s, max_step_s, min_step_s.
std::span<const Parameter> integrator_table_parameters();
/// The integrators' option that a key of the table sets.
std::string_view option_of(std::string_view key);
/// The keys that apply to only one integrator.
std::span<const Use> integrator_uses();

/// Description of one table of a scene.
struct TableEntry {
  std::string name;                       // "strand"
  std::string summary;                    // one line
  std::span<const Parameter> parameters;  // keys of the table
  std::string_view choice = {};    // the key whose value decides which others apply,
  std::span<const Use> uses = {};  // and which these are
  bool needed = false;             // in a scene of one strand
  bool many = false;               // [[name]]
};

/// All tables but [model], in the order in which a scene is written.
std::vector<TableEntry> table_entries();

}  // namespace tress::simulation
