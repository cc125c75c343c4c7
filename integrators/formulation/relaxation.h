#pragma once

#include <optional>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/integrator.h"

namespace tress::integrators {

/// Diagonal of M at the start; empty if M is not diagonal or not available.
std::optional<std::vector<double>> diagonal_mass(System& system);

/// Moves positions onto g = 0 by successive relaxation: one constraint after the other,
/// weighted by inverse masses, in sweeps until all hold. A sweep applies, in the order of
/// the constraints,
///
///     q -= omega g_k W G_k^T / (G_k W G_k^T),   W = M^-1 diagonal
///
/// with g_k updated to first order during the sweep. g and G are re-evaluated when the
/// violation has fallen tenfold. Internal constraints preserve the centre of mass. The
/// factor omega = 2/(1 + sin(pi/(2 m + 1))) is optimal for a chain of m equal links held
/// at one end. Its Jacobi iteration has the spectral radius cos(pi/(2 m + 1)) [Young
/// 1971, Iterative Solution of Large Linear Systems, section 6.2]. Any omega in (0, 2)
/// converges. One digit then costs about m sweeps. [Provot 1995, Graphics Interface,
/// section 5]
class Relaxation {
 public:
  /// Takes `tolerance` relative to the scales of g.
  Relaxation(System& system, double tolerance);

  /// `retry` when |g| over its scale does not reach the tolerance.
  Status positions(double t, InOut q) noexcept;

  long sweeps() const { return sweeps_; }  // so far

 private:
  Status linearize(double t, In q) noexcept;
  /// One sweep over step_; returns the largest violation met.
  double sweep() noexcept;

  ConstraintForm& constraints_;
  double tolerance_;
  double factor_;  // omega
  long sweeps_ = 0;
  std::vector<double> inverse_mass_, step_;             // (n)
  std::vector<double> g_, g_typ_, stiffness_, values_;  // (m), (m), G_k W G_k^T, G^T
};

}  // namespace tress::integrators
