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

std::span<const ModelEntry> model_catalogue();

/// What ModelEntry::make reads: the model's own options, and for a model of a strand
/// before them strand_parameters(), with the values of `motion` that it takes.
std::span<const Parameter> setup_parameters(const ModelEntry& model);

/// Throws InputError naming the nearest id if there is no such model.
const ModelEntry& find_model(std::string_view id);

}  // namespace tress::models
