#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/entry.h"

namespace tress::models {

/// Names and values of setup_parameters().
using ModelSettings = std::vector<std::pair<std::string, std::string>>;

/// Returns the models of tress, then those of plug-ins.
std::span<const ModelEntry> model_catalogue();
std::span<const ModelEntry> added_models();  // those of plug-ins

/// Before the catalogue is first read. Throws InputError naming `where` if it has been,
/// on an id that another model has, and on an entry that cannot be used.
void add_model(const ModelEntry& model, const std::string& where);

/// Returns the parameters that ModelEntry::make reads: the model's own options. For a
/// model of a strand strand_parameters() come first, with the values of `motion` that it
/// takes.
std::span<const Parameter> setup_parameters(const ModelEntry& model);

/// Throws InputError naming the nearest id if there is no such model.
const ModelEntry& find_model(std::string_view id);

}  // namespace tress::models
