#include "experiments/problems/strand_models.h"

#include <algorithm>

namespace tress::experiments {
namespace {

const Parameter* parameter(const ModelEntry& model, std::string_view key) {
  const std::span<const Parameter> all = setup_parameters(model);
  const auto found = std::ranges::find(all, key, &Parameter::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

std::vector<const ModelEntry*> strand_models() {
  std::vector<const ModelEntry*> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand != nullptr) all.push_back(&model);
  }
  return all;
}

std::string_view first_word(const ModelEntry& model, std::string_view key) {
  const Parameter* choice = parameter(model, key);
  return choice == nullptr ? std::string_view() : words_of(choice->choices).front();
}

bool has_word(const ModelEntry& model, std::string_view key, std::string_view word) {
  const Parameter* choice = parameter(model, key);
  if (choice == nullptr) return false;
  const auto words = words_of(choice->choices);
  return std::ranges::find(words, word) != words.end();
}

std::string_view usual_tangent(const ModelEntry& model) {
  return has_word(model, "jacobian", "elastic") ? "elastic"
                                                : first_word(model, "jacobian");
}

void set_known(
    Parameters& parameters,
    std::initializer_list<std::pair<std::string_view, std::string_view>> settings) {
  for (const auto& [key, word] : settings) {
    if (parameters.knows(key)) parameters.set(key, word);
  }
}

void set_known(Parameters& parameters, const ModelSettings& settings) {
  for (const auto& [key, value] : settings) {
    if (parameters.knows(key)) parameters.set(key, value);
  }
}

ModelSettings known_to(const ModelEntry& model, const ModelSettings& settings) {
  ModelSettings known;
  for (const auto& [key, value] : settings) {
    if (parameter(model, key) != nullptr) known.emplace_back(key, value);
  }
  return known;
}

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
