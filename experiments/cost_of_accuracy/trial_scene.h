#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/changes.h"

namespace tress::experiments::cost_of_accuracy {

/// A scene whose model, integrator, numbers of elements and steps are left open. Throws
/// InputError as read_scene does, and where the scene has no strand or strands that touch
/// each other.
Scene read_open_scene(const std::string& file);

/// The scene by this method, with `elements` per strand, `rate` frames per second and
/// steps that divide a frame. Throws InputError as with_elements does.
Scene trial_scene(Scene given, const Method& method, int elements, int substeps,
                  double rate);

/// Everything that determines the continuous solution, for keys of references: the scene
/// without the open choices, and the contents of the files it names.
std::string physics(Scene scene);

/// Newton's corrections below 1e-6 of the scale of an unknown: a thousandth of the
/// smallest target error.
inline constexpr double newton_tolerance = 1e-6;

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
