#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "contract/system.h"
#include "models/strand/strand_parameters.h"

namespace tress::models {

/// Roots that a model of a strand takes: `clamped_or_free`, or only `clamped`.
enum class Roots { clamped_or_free, clamped };

/// One line of the list of models: what `--list` prints and how to make a model from its
/// parameters. A model's file ends with a function `ModelEntry <id>_entry()`, which is
/// listed in catalogue.cpp.
struct ModelEntry {
  std::string_view id;                    // id in scenes
  std::string_view summary;               // unknowns and variants, one line
  std::string_view source;                // author year, or test set
  std::span<const Parameter> parameters;  // its own options
  /// Reads setup_parameters() (models/catalogue.h).
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
  Roots roots = Roots::clamped_or_free;  // roots that the model takes
  /// Errors fall with this power of the length of elements.
  int order = 2;
};

/// Function that makes a model on a strand.
using OnStrand = std::unique_ptr<System>(const Strand&, const Parameters&, Effects);

/// Makes a system on the strand that strand_parameters() describe.
template <OnStrand* make>
std::unique_ptr<System> on_described_strand(const Parameters& parameters) {
  return make(strand(parameters), parameters, strand_effects(parameters));
}

}  // namespace tress::models
