#pragma once

#include <string>
#include <vector>

#include "models/turning/turning_system.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Returns true if the strand turns this body (moves = "turns").
bool turns(const EffectChoice& choice);
/// Returns true if the scene has such a body.
bool has_turning_bodies(const Scene& scene);
/// Returns the names of these bodies, as effect_names().
std::vector<std::string> turning_body_names(const Scene& scene);
/// Throws InputError with the location of the body if the rest of the scene does not
/// admit it. `places`: of each effect's table; `strands`: number of the scene's strands.
void check_turning_bodies(const Scene& scene, const std::vector<std::string>& places,
                          std::size_t strands);

}  // namespace tress::simulation
