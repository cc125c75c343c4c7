#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress {

// A scene is a value: what is to be another scene is made from it by a function of here.
// Nothing is read or checked again; what cannot be built is refused by whoever builds it
// (World).

/// How a scene is simulated, but for the cut in space and time.
struct Method {
  const ModelEntry* model = nullptr;
  /// Of the model, where not the default: keys and values.
  std::vector<std::pair<std::string, std::string>> options;
  std::string integrator;
  Formulation formulation = Formulation::parametric;

  /// The word of a choice of the model; empty where it has no such choice.
  std::string_view word(std::string_view choice) const;
};

/// By this method; of the integrator's options only the step stays. Throws InputError on
/// options that the model does not have.
Scene with_method(Scene scene, const Method& method);

/// The same strands in so many equal elements each, shapes averaged over them. Throws
/// InputError unless there is one at least, and on strands that branch.
Scene with_elements(Scene scene, int elements);

}  // namespace tress
