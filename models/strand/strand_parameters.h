#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/strand/strand.h"

namespace tress::models {

/// The values of `root` for models whose root cannot move freely.
inline constexpr std::string_view bound_root_choices =
    "fixed|shake|rotate|shake_rotate|swing|stop|drop_pull";

/// The catalogue parameters that every strand model shares, followed by its own.
std::vector<Parameter> with_strand_parameters(std::span<const Parameter> own);
/// The same for models that define their own geometry (trees): material, root motion and
/// effects, but no length, discretisation or shape.
std::vector<Parameter> with_material_parameters(std::span<const Parameter> own);

/// Throws InputError on poisson_ratio = -1.
Material material(const Parameters& parameters);

/// The clamp, at rest at the origin: e0 along root_tangent, e1 = y, so that curvature
/// about e1 bends in the x-z plane (positive: towards -e2, down for root_tangent x).
/// "Sideways" is y for root_tangent x, else x. With f = frequency_hz:
///
///     fixed, free    at rest (free: see free_root)
///     shake          amplitude_m sin(2 pi f t) sideways
///     rotate         head_angle_rad sin(2 pi f t) about a vertical axis, head_radius_m
///                    behind the root (towards -x)
///     shake_rotate   both
///     swing          amplitude_m (1 - cos 2 pi f t) along y
///     stop           sideways at stop_speed_m_s, from t = 0 to rest in stop_time_s
///     drop_pull      down by amplitude_m in half a period, up again in the next half
RootMotion root_motion(const Parameters& parameters);
/// For root = free: at the origin, at rest except for spin_rad_s about (1, 1, 1)/sqrt 3.
std::optional<FreeRoot> free_root(const Parameters& parameters);

/// Gravity along -z, and drag with mass-proportional damping as one effect; zero effects
/// are omitted.
Effects strand_effects(const Parameters& parameters);

/// Whether with_strand_parameters() adds this one to every model's own.
bool shared_by_strands(std::string_view parameter);

/// Material, section, discretisation, shapes and root. The section has half-axes radius_m
/// sqrt(ellipticity) along e1 and radius_m / sqrt(ellipticity) along e2, so its area does
/// not depend on ellipticity.
Strand strand(const Parameters& parameters);

}  // namespace tress::models
