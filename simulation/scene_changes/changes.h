#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

// A scene is a value; these functions derive other scenes from it. Nothing is read or
// checked again; World refuses what cannot be built.

/// Model, integrator and options of a scene, without its discretisation in space and
/// time.
struct Method {
  const ModelEntry* model = nullptr;                  // entry of the catalogue of models
  ModelSettings options;                              // of the model, if not the default
  std::string integrator;                             // id of the integrator
  Formulation formulation = Formulation::parametric;  // form of the constraints

  /// The option value of a choice of the model; empty if it has no such choice.
  std::string_view word(std::string_view choice) const;
};

/// The scene with this method; of the integrator's options only the step is kept. Throws
/// InputError on options that the model does not have.
Scene with_method(Scene scene, const Method& method);

/// Returns the scene with `elements` elements in each strand. Throws InputError as
/// read_scene does, and std::logic_error if the scene's tables no longer describe its
/// strands.
Scene with_elements(Scene scene, int elements);
/// Returns the scene with these numbers of elements in the strands of each [strand],
/// [groom] table, in their order, where an entry of `elements` is above 0. Throws as
/// above.
Scene with_elements_of_strands(Scene scene, std::span<const int> elements);
/// Returns the scene with `elements` elements that share the bending of a strand at
/// rest: mesh = "rest", or "rest_linear" where the scene's model is super_clothoid.
/// Only of [strand] tables, without points.
Scene with_elements_at_rest(Scene scene, int elements);
/// Returns whether with_elements_at_rest() accepts the scene.
bool may_cut_at_rest(const Scene& scene);
/// Returns the scene with twice the elements in every strand.
Scene with_twice_the_elements(Scene scene);

/// Returns the scene with every strand of its grooms simulated, none a follower, and
/// equal numbers of elements in all strands of a table. Grooms keep fewer strands if
/// there are more than `most` altogether. The scene may be that of an outline.
Scene every_strand(Scene scene, std::size_t most);
/// Returns the scene with `guides` guides, at most the number of strands. The grooms
/// share them by their numbers of strands, at least one each; all other strands follow.
Scene with_guides(Scene scene, std::size_t guides);
/// Returns the indices of these guides among the strands of every_strand().
std::vector<std::size_t> guides_of(const Scene& scene, std::size_t guides);

/// The scene with other strands, which no table describes, in the place of its own. What
/// [[supports]], [[joints]], moments and natural shapes over time say holds for them.
Scene with_strands(Scene scene, std::vector<Strand> strands);

/// The scene without any effect.
Scene bare(Scene scene);

/// At most `most` typical strands; all if strands touch each other.
Scene thinned(Scene scene, std::size_t most);
/// The scene with only these strands and what acts on them. Throws InputError if joints
/// join strands.
Scene only(Scene scene, const std::vector<std::size_t>& strands);

/// Segments divided into halves of the same shape, steps halved: the difference from the
/// scene itself measures its discretisation error.
Scene refined(Scene scene);

/// A removable part of a scene: an effect it names, or a mode of its model.
struct Ingredient {
  std::string name;  // name of the effect or mode
  /// Returns the scene without it.
  std::function<Scene(const Scene&)> without;
  /// The scene with only this effect. Empty for modes.
  std::function<Scene(const Scene&)> alone;
};

/// Returns all removable parts of a scene.
std::vector<Ingredient> ingredients(const Scene& scene);

}  // namespace tress::simulation
