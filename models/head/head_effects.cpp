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
  const Viscosity air = viscosity(options.effects);
  options.gravity = options.gravity + uniform_acceleration(options.effects);
  options.drag += air.per_length;
  options.mass_damping += air.per_mass;
  std::erase_if(options.effects,
                [](const auto& effect) { return !depends_on_place(*effect); });
}

}  // namespace tress::models
