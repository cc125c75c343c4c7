#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// A straight, weightless hair that rings in one of its modes, observed in time.
///
/// friction: released from the shape of its first bending mode. With Kelvin-Voigt
///   friction gamma in bending that mode decays by the rate (gamma/EI) omega^2/2, omega =
///   1.8751^2 sqrt(EI/(rho S L^4)): the basis of the calibration of gamma.
///
/// torsion: released from the shape of a torsional mode: omega_n = (2 n - 1) pi/2
///   sqrt(G/rho)/L, a twist wave running to and fro. Observed in the kinetic energy,
///   which oscillates as sin^2(omega t): not every model reports the rotation of its tip.
std::vector<ValidationTest> ringing_tests();

}  // namespace tress::experiments::validation
