#pragma once

#include <string>
#include <vector>

#include "experiments/problems/strand_models.h"

namespace tress::experiments {

/// A strand model with its choices of how lengths are kept.
struct ModelVariant {
  const ModelEntry* model;
  ModelSettings settings;
  std::string words;  // "stretch=inextensible"; empty: the model as it comes
};

/// Every strand model as it comes and with every other word of its choices `stretch` and
/// `stretch_springs`.
std::vector<ModelVariant> length_variants();

}  // namespace tress::experiments
