#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/cost_of_accuracy/trial_scene.h"

namespace tress::experiments::cost_of_accuracy {

/// Every strand model with its options and every fixed-step integrator that can drive it
/// on this scene. Tolerance-controlled methods are excluded: their cost per frame is not
/// known beforehand.
struct MethodChoice {
  std::vector<std::string> models, integrators;  // empty: all
  /// Varied options of models, "key" or "key=word"; empty: all. `modes` and `tangent` in
  /// all pairs, others one at a time.
  std::vector<std::string> options;
};
std::vector<Method> methods(const Scene& given, const MethodChoice& choice);

/// Methods that differ from `method` in this one option of the model and can represent
/// the scene.
std::vector<Method> with_other_words(const Scene& given, const Method& method,
                                     std::string_view choice);

/// The model's options.
std::vector<std::string_view> choices_of(const ModelEntry& model);

/// The same model, integrator and options.
bool same(const Method& a, const Method& b);

}  // namespace tress::experiments::cost_of_accuracy
