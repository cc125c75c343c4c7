#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/strand/strand.h"

namespace tress::models {

// A strand with a clamp, gravity and drag from a list of numbers, for programs and tests
// that put a model on a strand without a scene. No model declares these as its own.

/// The values of `motion` for models whose root cannot move freely.
inline constexpr std::string_view bound_root_choices =
    "fixed|shake|rotate|shake_rotate|swing|stop|drop_pull";

/// Geometry, then material_parameters().
std::span<const Parameter> strand_parameters();
/// Material, root motion, gravity and drag, for models that bring their own geometry
/// (trees).
std::span<const Parameter> material_parameters();

/// Throws InputError on poisson_ratio = -1, and where shear_modulus_pa is set and
/// poisson_ratio is not the default.
Material material(const Parameters& parameters);

/// The clamp, at rest at the origin: e0 along root_tangent, e1 = y, so that curvature
/// about e1 bends in the x-z plane (positive: towards -e2, down for root_tangent x).
/// "Sideways" is y for root_tangent x, else x. With f = frequency_hz:
///
///     fixed, free    at rest (free: see free_root)
///     shake          amplitude_m sin(2 pi f t) sideways
///     rotate         angle_rad sin(2 pi f t) about a vertical axis, head_radius_m
///                    behind the root (towards -x)
///     shake_rotate   both
///     swing          amplitude_m (1 - cos 2 pi f t) along y
///     stop           sideways at speed_m_s, from t = 0 to rest in time_s
///     drop_pull      down by amplitude_m in half a period, up again in the next half
RootMotion root_motion(const Parameters& parameters);
/// Returns the root for motion = free: at the origin, at rest except for spin_rad_s about
/// (1, 1, 1)/sqrt 3.
std::optional<FreeRoot> free_root(const Parameters& parameters);

/// Gravity along -z, and drag with mass-proportional damping as one effect; zero effects
/// are omitted.
Effects strand_effects(const Parameters& parameters);

/// Material, section, discretisation, shapes and root. The section has half-axes radius_m
/// sqrt(ellipticity) along e1 and radius_m / sqrt(ellipticity) along e2, so its area does
/// not depend on ellipticity.
Strand strand(const Parameters& parameters);

}  // namespace tress::models
