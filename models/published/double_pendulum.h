#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "contract/system.h"

namespace tress::models {

/// Double pendulum: two point masses on massless rods in the plane, angles q = (theta_1,
/// theta_2) in rad from the downward vertical, no constraints, no damping:
///
///     M = [(m1 + m2) l1^2, c; c, m2 l2^2],   c = m2 l1 l2 cos(theta_1 - theta_2)
///     V = -(m1 + m2) g l1 cos theta_1 - m2 g l2 cos theta_2
///
/// Material points: the two masses, z up, pivot at the origin. Chaotic at large angles:
/// judge long runs by energy, not by position.
/// Source: L. Landau, E. Lifshitz, Mechanics (3rd ed.), section 5, problem 1.
std::span<const Parameter> double_pendulum_parameters();
std::unique_ptr<System> make_double_pendulum(const Parameters& parameters);

}  // namespace tress::models
