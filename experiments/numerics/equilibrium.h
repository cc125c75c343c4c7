#pragma once

#include <memory>
#include <vector>

#include "contract/system.h"
#include "models/catalogue.h"

namespace tress::experiments {

/// A strand in equilibrium under its weight.
struct AtRest {
  std::unique_ptr<System> system;
  std::vector<double> q;
};

/// Computes the equilibrium r(q) = 0 at v = a = 0 by Newton's iteration from the initial
/// state, with gravity raised in steps to the value in `parameters`. For models without
/// constraints and with an exact Jacobian. Throws std::runtime_error when it does not
/// converge.
AtRest at_rest(const ModelEntry& model, const Parameters& parameters);

/// Small undamped motions about an equilibrium q, x'' = -M^-1 K x with K = dr/dq: x ~
/// exp(s t), s^2 = -(eigenvalues of M^-1 K). The eigenvalues are positive if M and K are
/// symmetric positive definite; in general they may be arbitrary.
struct LinearModes {
  double slowest_rad_s = 0;  // least |s|
  double growth_per_s = 0;   // largest real part of s; 0: no growth
  int complex_modes = 0;     // number of non-real eigenvalues
};

/// Returns the linear modes of a model without constraints and with a regular M,
/// symmetric or not. O(n^3).
LinearModes linear_modes(System& system, In q);

}  // namespace tress::experiments
