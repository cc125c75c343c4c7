#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// A straight hair, without weight, that rings in one of its modes, seen in time.
///
/// friction: bent in the shape of its first bending mode and let go. With Kelvin-Voigt
///   friction gamma in bending that mode decays by the rate (gamma/EI) omega^2/2, omega =
///   1.8751^2 sqrt(EI/(rho S L^4)): what the calibration of gamma rests on.
///
/// torsion: twisted in the shape of a mode of torsion and let go: omega_n = (2 n - 1)
///   pi/2 sqrt(G/rho)/L, the twist of the seeds' experiment running to and fro. Seen in
///   the kinetic energy, which swings as sin^2(omega t): not every model tells how its
///   tip turns.
std::vector<ValidationTest> ringing_tests();

}  // namespace tress::experiments::validation
