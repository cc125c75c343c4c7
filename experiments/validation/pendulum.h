#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// Tests of the pendulum limit of a strand: a stiff rod of length L and mass m that hangs
/// on a hinge. The hinge is one thin short segment of length l and bending stiffness k (N
/// m per rad), clamped at the angle a from the vertical. The rod is released straight. It
/// swings by
///
///     I theta'' = -m g c sin theta - k (theta - a),
///
/// small: omega^2 = (m g L/2 + k)/(m L^2/3) [Landau & Lifshitz 1976, section 32]; large,
/// k = 0: the period is 4 K(sin(a/2))/omega. We take c and I about the middle of the
/// hinge, L - l/2 for L, and the period by quadrature of the energy.
///
/// The hinge is weak, k = 0.0005 m g L/2, so that the test judges the rod and not the
/// hinge. Nodal models put the spring of a clamp over half a segment, which makes it 2 k.
std::vector<ValidationTest> pendulum_tests();

/// Period (s) of the equation above for the test's rod.
double pendulum_period(double amplitude);

}  // namespace tress::experiments::validation
