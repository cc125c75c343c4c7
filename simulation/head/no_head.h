#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

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
/// Methods that heads have, by the ids of integrators.
inline constexpr std::pair<std::string_view, models::HeadMethod> head_methods[] = {
    {"semi_implicit_euler", models::HeadMethod::semi_implicit_euler},
    {"linearly_implicit_midpoint", models::HeadMethod::linearly_implicit_midpoint},
    {"backward_euler", models::HeadMethod::backward_euler},
    {"tr_bdf2", models::HeadMethod::tr_bdf2}};
/// The one of a scene's integrator, if there is one.
std::optional<models::HeadMethod> head_method(const Scene& scene);

}  // namespace tress::simulation
