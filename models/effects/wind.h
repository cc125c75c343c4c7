#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "models/effects/catalogue.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of quadratic_drag.
std::span<const Parameter> quadratic_drag_parameters();
/// Returns which of them apply to which coefficients.
std::span<const EffectUse> quadratic_drag_uses();

/// Quadratic drag of still air, different across and along the strand
/// (AnisotropicAirLaw, effects/air_law.h). In moving air use the effect `wind` instead.
std::unique_ptr<const Effect> make_quadratic_drag(const Parameters& parameters,
                                                  const RootMotion& head);

/// Returns the parameters of wind.
std::span<const Parameter> wind_parameters();
/// Returns which of them apply to which profile and law.
std::span<const EffectUse> wind_uses();

/// Makes the load of moving air from a field of effects/wind_field.h (`profile`) and a
/// law of effects/air_law.h (`law`) for the relative velocity. Laws of a relative
/// velocity include the drag: use them instead of linear_drag or quadratic_drag. With law
/// = force, the wind exerts a given force per length, F w/|U|, with F in N/m and U the
/// given velocity. That force is independent of the strand's motion and includes no drag.
/// Throws InputError if U = 0 with law = force.
std::unique_ptr<const Effect> make_wind(const Parameters& parameters,
                                        const RootMotion& head);

}  // namespace tress::models
