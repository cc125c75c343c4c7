#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "contract/system.h"

namespace tress::models {

/// Slider crank whose connecting rod is flexible: crank driven at constant angular
/// velocity, rod with two lateral sine modes and two longitudinal quadratic modes,
/// sliding block.
///
///     M(q) a - f(q, v) - G(q)^T lambda = 0,   g(t, q) = 0,   n = 7, m = 3
///
/// q = (phi_1, phi_2 in rad, x_3 in m, q_1..q_4 elastic, m); g = (crank and rod end on
/// the slide's axis, block at the rod's end, both in m; phi_1 = Omega t, in rad). The
/// rod's end moves with q_4, so the first two constraints carry it. lambda has the
/// opposite sign to the Test Set's. No damping, no gravity, linear elasticity: the Test
/// Set's default, to which its end values at t = 0.1 s belong (references.h).
/// `start = rigid` is its second start, on the rigid motion, which makes the rod ring.
///
/// Source: B. Simeon, Modelling a flexible slider crank mechanism by a mixed system of
/// DAEs and PDEs, Math. Modelling of Systems 2 (1996) 1-18; Mazzia & Magherini, Test Set
/// for IVP Solvers, release 2.4, problem "crank". Difference here: block position and
/// velocities are completed from the constraints, which the nine printed digits satisfy
/// only to 1e-9.
std::span<const Parameter> slider_crank_parameters();
std::unique_ptr<System> make_slider_crank(const Parameters& parameters);

}  // namespace tress::models
