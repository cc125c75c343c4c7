#pragma once

#include "contract/system.h"

namespace tress {

/// Products with the transposed derivatives of the residual, an optional form of systems
/// whose residual and Jacobian are recursions and not matrices. Gradients backward in
/// time need them (integrators/gradient).
class TransposedForm {
 public:
  virtual ~TransposedForm() = default;
  /// Prepares pull() at a state. False: not available.
  virtual bool place_transposed(double t, In q, In v, In a) noexcept = 0;
  /// Computes (dr/dq)^T mu, (dr/dv)^T mu.
  virtual void pull(In mu, Out by_q, Out by_v) noexcept = 0;
};

/// Null if the system has none.
inline TransposedForm* transposed_form(System& system) {
  return dynamic_cast<TransposedForm*>(&system);
}

}  // namespace tress
