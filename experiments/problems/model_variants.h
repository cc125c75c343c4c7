#pragma once

#include <string>
#include <vector>

#include "experiments/problems/strand_models.h"

namespace tress::experiments {

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
