#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

std::span<const Parameter> quadratic_drag_parameters();

/// Quadratic drag of still air, different across and along the strand
/// (AnisotropicAirLaw, effects/air_law.h). In moving air use the effect `wind` instead.
std::unique_ptr<const Effect> make_quadratic_drag(const Parameters& parameters,
                                                  const RootMotion& head);

}  // namespace tress::models
