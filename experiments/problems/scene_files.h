#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/catalogue.h"
#include "simulation/scene/scene.h"

namespace tress::experiments {

/// A scene file under its full name with extension, which no built-in scene has.
struct SceneFile {
  std::string name;
  Scene scene;
};

/// Reads scenes that every strand model can be tried on. Throws InputError as read_scene
/// does, on a scene whose model brings its own geometry, and on two files of one name.
std::vector<SceneFile> read_strand_scenes(const std::vector<std::string>& files);

/// Returns the scene simulated by this model and integrator. A model other than the
/// scene's own has its default options. A formulation that the integrator does not
/// support, and index 3 with a tolerance on supports, is replaced by the one it prefers.
/// A tolerance is kept if the integrator controls its error. Throws InputError where the
/// model cannot do the scene or the integrator cannot drive the model.
Scene driven(Scene scene, const ModelEntry& model, const IntegratorEntry& entry);

/// The Jacobians to try on the scene's own model: the scene's, and the usual one for the
/// method that solves only once a step; {""} if the model has no choice. They are views
/// into the scene and the catalogue.
std::set<std::string_view> scene_jacobians(const Scene& scene,
                                           std::string_view integrator);

/// Element count of the strand with the most elements.
std::size_t most_elements(const Scene& scene);

}  // namespace tress::experiments
