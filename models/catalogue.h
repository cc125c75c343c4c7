#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/entry.h"

namespace tress::models {

/// Names and values of a model's parameters.
using ModelSettings = std::vector<std::pair<std::string, std::string>>;

std::span<const ModelEntry> model_catalogue();

/// Throws InputError naming the nearest id if there is no such model.
const ModelEntry& find_model(std::string_view id);

}  // namespace tress::models
