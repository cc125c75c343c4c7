#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

// A scene is a value: what is to be another scene is made from it by a function of here.
// Nothing is read or checked again; what cannot be built is refused by whoever builds it
// (World).

/// How a scene is simulated, but for the cut in space and time.
struct Method {
  const ModelEntry* model = nullptr;
  ModelSettings options;  // of the model, where not the default
  std::string integrator;
  Formulation formulation = Formulation::parametric;

  /// The word of a choice of the model; empty where it has no such choice.
  std::string_view word(std::string_view choice) const;
};

/// By this method; of the integrator's options only the step stays. Throws InputError on
/// options that the model does not have.
Scene with_method(Scene scene, const Method& method);

/// The same strands in so many elements each. Throws InputError as read_scene does, and
/// std::logic_error where the tables of the scene no longer say its strands.
Scene with_elements(Scene scene, int elements);

/// Other strands, which no table says.
Scene with_strands(Scene scene, std::vector<Strand> strands);

/// The scene without any effect and interaction.
Scene bare(Scene scene);

/// At most `most` of its strands, typical ones; where they touch each other, all.
Scene thinned(Scene scene, std::size_t most);
/// These of its strands.
Scene only(Scene scene, const std::vector<std::size_t>& strands);

/// Segments cut in halves of the same shape, steps halved: what the difference from the
/// scene itself says about its discretisation.
Scene refined(Scene scene);

/// One thing that a scene could do without: an effect it names, its strand-strand
/// interaction, or a mode of its model.
struct Ingredient {
  std::string name;
  std::function<Scene(const Scene&)> without;
  /// The scene with none of its effects but this one. Empty for modes.
  std::function<Scene(const Scene&)> alone;
};

std::vector<Ingredient> ingredients(const Scene& scene);

}  // namespace tress::simulation
