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

/// The roots that a model of a strand takes.
enum class Roots { clamped_or_free, clamped };

/// One line of the list of models: what `--list` prints and how to make a model from its
/// parameters. A new model needs its own files, one line here and one CMake line.
struct ModelEntry {
  std::string_view id;
  std::string_view summary;               // unknowns and variants, one line
  std::string_view source;                // author year, or test set
  std::span<const Parameter> parameters;  // its own options
  /// Reads setup_parameters().
  std::unique_ptr<System> (*make)(const Parameters&);
  /// Makes the model for a given strand and effects, with its own options. Null if the
  /// model defines its own geometry.
  std::unique_ptr<System> (*on_strand)(const Strand&, const Parameters&,
                                       Effects) = nullptr;
  /// Batches two to four strands of equal discretisation as one system, at little more
  /// than the cost of one; returns null if these options do not support it. Null if the
  /// model has no batched form.
  std::unique_ptr<System> (*on_strands)(std::span<const Strand>, const Parameters&,
                                        std::vector<Effects>) = nullptr;
  Roots roots = Roots::clamped_or_free;
};

/// Names and values of setup_parameters().
using ModelSettings = std::vector<std::pair<std::string, std::string>>;

std::span<const ModelEntry> model_catalogue();

/// What ModelEntry::make reads: the model's own options, and for a model of a strand
/// before them strand_parameters(), with the values of `motion` that it takes.
std::span<const Parameter> setup_parameters(const ModelEntry& model);

/// Throws InputError naming the nearest id if there is no such model.
const ModelEntry& find_model(std::string_view id);

}  // namespace tress::models
