#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// A strand that behaves as a chain: one metre long, with negligible bending stiffness
/// (EI/(rho g S L^3) = 1e-7) and stretched by its weight by 1e-5.
///
/// whip: a pulse of the clamp, amplitude sin^4(pi t/D), runs down the hanging chain at
///   c = sqrt(g s), s from the free end. In u = 2 sqrt(s/g) small motions obey the
///   radial wave equation y_tt = y_uu + y_u/u; to the next order a pulse F changes its
///   shape by F + (1/(8 u)) int F, which moves its peak by (1/u_2 - 1/u_1)/8 |F/F''| =
///   0.1 ms, 5e-4 of the travel.
///
/// falling_chain: released horizontally from a clamp, the tip falls freely,
///   z = -g t^2/2, until the wave of the constraint arrives.
///
/// folded_chain: hangs folded in two, its ends side by side, and one is released. By
///   conservation of energy v^2 = g x (2 L - x)/(L - x) after a fall by x, which is
///   faster than free fall [Calkin & March 1989, Am. J. Phys. 57, 154; Tomaszewski,
///   Pieranski & Geminard 2006, Am. J. Phys. 74, 776]. A fold of finite length, a half
///   circle, changes neither energy at the same x as long as it falls upright.
std::vector<ValidationTest> chain_tests();

}  // namespace tress::experiments::validation
