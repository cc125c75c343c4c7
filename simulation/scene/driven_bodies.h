#pragma once

#include <string>
#include <vector>

#include "models/driven/driven_system.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Returns true if strands drive this body (moves = "turns" or "free").
bool driven(const EffectChoice& choice);
/// Returns true if the scene has such a body.
bool has_driven_bodies(const Scene& scene);
/// A body that strands drive.
struct DrivenName {
  std::string name;  // as effect_names()
  bool free;         // moves = "free"
};
/// Returns these bodies in the order of the scene.
std::vector<DrivenName> driven_body_names(const Scene& scene);
/// Throws InputError with the location of the body if the rest of the scene does not
/// admit it. `places`: of each effect's table; `strands`: number of the scene's strands.
void check_driven_bodies(const Scene& scene, const std::vector<std::string>& places,
                         std::size_t strands);

}  // namespace tress::simulation
