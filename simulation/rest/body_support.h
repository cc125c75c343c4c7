#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "models/effects/effect.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Bodies that hold a strand at rest by contact (held_shape.h).
struct HoldingBodies {
  int contacts = 0;  // points with a force
  /// Offsets for with_offsets() of each body, by its index among the effects.
  std::vector<std::pair<std::size_t, std::vector<double>>> offsets;
};

/// For a strand of a scene without motion, with its model's options, under these effects.
/// Throws InputError if it is inside a body whose forces are not a function of the state.
HoldingBodies body_support(const Scene& scene, const Strand& strand,
                           const Parameters& model_options,
                           const models::Effects& effects);

/// A body of body_support() with its offsets.
std::shared_ptr<const models::Effect> with_offsets(const models::Effect& body,
                                                   const std::vector<double>& more);

}  // namespace tress::simulation
