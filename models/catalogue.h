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

/// One line of the list of models: what `--list` prints and how a model is made from its
/// parameters. Adding a model = its own files, one line here, one CMake line.
struct ModelEntry {
  std::string_view id;
  std::string_view summary;  // unknowns and variants, one line
  std::string_view source;   // author year, or test set
  std::span<const Parameter> parameters;
  std::unique_ptr<System> (*make)(const Parameters&);
  /// Of models of a strand: the model on any strand under any effects. Of the parameters
  /// it reads those that models do not share (models/strand/strand_parameters.h). Null:
  /// the model brings its own geometry.
  std::unique_ptr<System> (*on_strand)(const Strand&, const Parameters&,
                                       Effects) = nullptr;
  /// The same of two to four strands that are cut alike, as one system at the cost of
  /// little more than one strand; returns null where these options cannot. Null: the
  /// model has no such thing.
  std::unique_ptr<System> (*on_strands)(std::span<const Strand>, const Parameters&,
                                        std::vector<Effects>) = nullptr;
};

/// Parameters of a model by name, and what they are set to.
using ModelSettings = std::vector<std::pair<std::string, std::string>>;

std::span<const ModelEntry> model_catalogue();

/// Throws InputError naming the nearest id when there is no such model.
const ModelEntry& find_model(std::string_view id);

}  // namespace tress::models
