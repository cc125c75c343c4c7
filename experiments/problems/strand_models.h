#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/catalogue.h"
#include "simulation/run/simulation.h"

namespace tress::experiments {

/// The models of the catalogue that take any strand: every strand scene runs on each.
std::vector<const ModelEntry*> strand_models();

/// The default of an option, empty if the model has no such parameter.
std::string_view first_word(const ModelEntry& model, std::string_view key);

bool has_word(const ModelEntry& model, std::string_view key, std::string_view word);

/// Jacobian of the linearly implicit step: the stiff one, or the default of models
/// without it.
std::string_view usual_tangent(const ModelEntry& model);

/// Sets those parameters that the model has.
void set_known(
    Parameters& parameters,
    std::initializer_list<std::pair<std::string_view, std::string_view>> settings);

void set_known(Parameters& parameters, const ModelSettings& settings);

/// The settings whose keys the model knows.
ModelSettings known_to(const ModelEntry& model, const ModelSettings& settings);

/// A strand model with its options for keeping lengths.
struct ModelVariant {
  const ModelEntry* model;
  ModelSettings settings;
  std::string words;  // "stretch=inextensible"; empty: model defaults
};

/// Every strand model with its defaults and with every other value of its options
/// `stretch` and `stretch_springs`.
std::vector<ModelVariant> length_variants();

}  // namespace tress::experiments
