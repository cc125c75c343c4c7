#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of quadratic_drag.
std::span<const Parameter> quadratic_drag_parameters();

/// Quadratic drag of still air, different across and along the strand
/// (AnisotropicAirLaw, effects/air_law.h). In moving air use the effect `wind` instead.
std::unique_ptr<const Effect> make_quadratic_drag(const Parameters& parameters,
                                                  const RootMotion& head);

/// Returns the parameters of wind.
std::span<const Parameter> wind_parameters();

/// Makes the load of moving air: a field of effects/wind_field.h (`profile`) and a law of
/// effects/air_law.h (`law`) for the relative velocity. Laws of a relative
/// velocity include the drag: use them instead of linear_drag or quadratic_drag. law =
/// force is a given force per length along the wind, F w/|U|, independent of the
/// strand's motion: it has no drag. F is in N/m and U the
/// given velocity. Throws InputError if U = 0 with law = force.
std::unique_ptr<const Effect> make_wind(const Parameters& parameters,
                                        const RootMotion& head);

}  // namespace tress::models
