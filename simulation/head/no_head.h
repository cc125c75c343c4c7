#pragma once

#include <optional>
#include <string>

#include "models/head/head.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Why a scene is no head of hair, and what would make it one.
struct NoHead {
  std::string reason, remedy;
};

/// What speaks against running a scene as one Head (models/head/head.h); nothing if it
/// can, with such numbers. Of strands it sees what their tables say: make_head() throws
/// InputError where a strand of them does not fit.
std::optional<NoHead> no_head(const SceneOutline& outline,
                              models::HeadNumber number = models::HeadNumber::float64);

/// Of a scene that can be a head: of springs, of rigid links, or else of super-helices.
bool steps_springs(const Scene& scene);
bool steps_chains(const Scene& scene);
/// The head's method by the integrator's id; nothing: heads do not have it.
std::optional<models::HeadMethod> head_method(const Scene& scene);

}  // namespace tress::simulation
