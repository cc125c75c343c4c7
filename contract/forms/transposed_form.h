#pragma once

#include <vector>

#include "contract/system.h"

namespace tress {

/// Solutions with the transposed Jacobian, an optional form of systems that eliminate
/// along a strand. Gradients backward in time need them (integrators/gradient).
///
/// The residual of such a system is a function of constants c (stiffnesses, natural
/// strains, frictions, masses) less the loads of effects. Parameters that change nothing
/// else cost nothing more than the products with dr/dc and with the loads, however many
/// there are. These products are power for the velocities v = mu.
class TransposedForm {
 public:
  virtual ~TransposedForm() = default;
  /// Factors S(w) at a state. False: not available there.
  virtual bool factor_transposed(double t, In q, In v, In a, Weights w) noexcept = 0;
  /// Solves S^T mu = b and computes (dr/dq)^T mu, (dr/dv)^T mu; (n) each.
  virtual Status solve_transposed(In b, Out mu, Out by_q, Out by_v) noexcept = 0;

  /// Returns the constants c. Empty: unknown, and the calls below are not available.
  virtual std::vector<double> constants() const = 0;
  /// Prepares the calls below at a state where mu is known; solve_transposed() does, too.
  virtual void place_transposed(double t, In q, In v, In a, In mu) noexcept = 0;
  /// Adds (dr/dc)^T mu to `by`, at fixed loads.
  virtual void add_by_constants(InOut by) noexcept = 0;
  /// Returns the power of the loads that the effects of `other` have at this state, W.
  /// NaN: `other` is another kind of system.
  virtual double power_of_loads(System& other) noexcept = 0;
};

/// Null if the system has none.
inline TransposedForm* transposed_form(System& system) {
  return dynamic_cast<TransposedForm*>(&system);
}

}  // namespace tress
