#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "contract/system.h"

namespace tress::models {

/// Andrews' squeezing mechanism: seven planar bodies, a spring, and a drive of constant
/// torque, closed by three loops that meet in one moving joint.
///
///     M(q) a - f(q, v) - G(q)^T lambda = 0,   g(q) = 0,   n = 7, m = 6
///
/// q = (beta, Theta, gamma, Phi, delta, Omega, epsilon) in rad; g in m (two components of
/// each closure); lambda in N, with the opposite sign to the Test Set's. Published end
/// values at t = 0.03 s in references.h. Tangent::stiff keeps M and the spring.
/// Source: Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem "andrews";
/// Hairer & Wanner, Solving Ordinary Differential Equations II, section VII.7.
std::span<const Parameter> andrews_squeezer_parameters();
std::unique_ptr<System> make_andrews_squeezer(const Parameters& parameters);

}  // namespace tress::models
