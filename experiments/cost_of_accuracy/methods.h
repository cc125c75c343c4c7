#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/cost_of_accuracy/trial_scene.h"

namespace tress::experiments::cost_of_accuracy {

/// Every strand model with its options and every fixed-step integrator that can drive it
/// on this scene. Methods whose step is controlled by a tolerance are not here: what a
/// frame costs them is not known beforehand.
struct MethodChoice {
  std::vector<std::string> models, integrators;  // empty: all
  /// Options of models that are varied, "key" or "key=word"; empty: all. Of `modes` and
  /// `tangent` all pairs, of others one at a time.
  std::vector<std::string> options;
};
std::vector<Method> methods(const Scene& given, const MethodChoice& choice);

/// Those that differ from `method` in this one choice of the model and can do the scene.
std::vector<Method> with_other_words(const Scene& given, const Method& method,
                                     std::string_view choice);

/// The choices that the model has.
std::vector<std::string_view> choices_of(const ModelEntry& model);

/// The same model, integrator and options.
bool same(const Method& a, const Method& b);

}  // namespace tress::experiments::cost_of_accuracy
