#include "models/head/head.h"

namespace tress::models {

std::optional<HeadRefusal> refused_by_heads(const Effect& effect) {
  const std::string name(effect.name());
  if (effect.for_strand(0) != nullptr) {
    return HeadRefusal{"effect " + name + " holds contact forces between steps",
                       "set friction_law = \"regularised\""};
  }
  if (effect.needs().couplings) {
    return HeadRefusal{"effect " + name + " couples the points of a strand",
                       "leave it out"};
  }
  return {};
}

void take_uniform_effects(LaneOptions& options) {
  std::erase_if(options.effects, [&](const auto& effect) {
    if (const auto acceleration = effect->uniform_acceleration()) {
      options.gravity = options.gravity + *acceleration;
      return true;
    }
    const auto viscosity = effect->viscosity();
    if (!viscosity) return false;
    options.drag += viscosity->per_length;
    options.mass_damping += viscosity->per_mass;
    return true;
  });
}

}  // namespace tress::models
