#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/parameters.h"
#include "contract/system.h"
#include "models/effects/effect.h"

namespace tress::models {

struct Strand;

/// One line of the list of models: what `--list` prints and how to make a model from its
/// parameters. A new model needs its own files, one line here and one CMake line.
struct ModelEntry {
  std::string_view id;
  std::string_view summary;  // unknowns and variants, one line
  std::string_view source;   // author year, or test set
  std::span<const Parameter> parameters;
  std::unique_ptr<System> (*make)(const Parameters&);
  /// Makes the model for a given strand and effects. Reads only the parameters that are
  /// not shared by strand models (models/strand/strand_parameters.h). Null if the model
  /// defines its own geometry.
  std::unique_ptr<System> (*on_strand)(const Strand&, const Parameters&,
                                       Effects) = nullptr;
  /// Batches two to four strands of equal discretisation as one system, at little more
  /// than the cost of one; returns null if these options do not support it. Null if the
  /// model has no batched form.
  std::unique_ptr<System> (*on_strands)(std::span<const Strand>, const Parameters&,
                                        std::vector<Effects>) = nullptr;
};

/// Names and values of a model's parameters.
using ModelSettings = std::vector<std::pair<std::string, std::string>>;

std::span<const ModelEntry> model_catalogue();

/// Throws InputError naming the nearest id if there is no such model.
const ModelEntry& find_model(std::string_view id);

}  // namespace tress::models
