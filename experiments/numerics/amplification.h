#pragma once

#include <optional>
#include <string_view>

#include "contract/layers.h"

namespace tress::experiments {

/// Effect of one step of a fixed-step method on the violation C of a constraint under
/// Baumgarte feedback. The test equation is
///     C'' + beta C' + alpha C = 0,   omega^2 = alpha,   beta = 2 zeta omega.
/// Small violations obey this equation in any motion, because the feedback acts along the
/// constraint's own gradient.

/// Spectral radius of the step's matrix on (C, h C') (velocity_verlet: with h^2 C'' too).
/// Empty for methods without a finite limit below.
std::optional<double> amplification(std::string_view integrator, double omega_h,
                                    double zeta);

/// Smallest omega h at which the radius exceeds one; empty when the method is A-stable
/// (its limit is infinite: both roots of the test equation lie in the left half-plane).
/// Known values at zeta = 1: explicit_euler 2, symplectic_euler 2 (sqrt 2 - 1),
/// rk4 2.785.
std::optional<double> largest_stable_omega_h(std::string_view integrator, double zeta);

}  // namespace tress::experiments
