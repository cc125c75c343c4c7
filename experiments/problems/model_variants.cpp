#include "experiments/problems/model_variants.h"

namespace tress::experiments {

std::vector<ModelVariant> length_variants() {
  std::vector<ModelVariant> all;
  for (const ModelEntry* model : strand_models()) {
    all.push_back({model, {}, ""});
    for (const Parameter& choice : model->parameters) {
      if (choice.name != "stretch" && choice.name != "stretch_springs") continue;
      const auto words = words_of(choice.choices);
      for (std::size_t i = 1; i < words.size(); ++i) {
        const std::string key(choice.name), word(words[i]);
        all.push_back({model, {{key, word}}, key + "=" + word});
      }
    }
  }
  return all;
}

}  // namespace tress::experiments
