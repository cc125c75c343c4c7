#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "models/parameters.h"
#include "models/system.h"

namespace tress {

/// One line of the list of models: what `--list` prints and how a model is made from its
/// parameters. Adding a model = its own files, one line here, one CMake line.
struct ModelEntry {
  std::string_view id;
  std::string_view summary;  // unknowns and variants, one line
  std::string_view source;   // author year, or test set
  std::span<const Parameter> parameters;
  std::unique_ptr<System> (*make)(const Parameters&);
};

std::span<const ModelEntry> models();

/// Throws InputError naming the nearest id when there is no such model.
const ModelEntry& find_model(std::string_view id);

}  // namespace tress
