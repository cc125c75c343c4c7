#pragma once

#include "integrators/sundials/cvode.h"
#include "integrators/sundials/implicit_adapter.h"

namespace tress::integrators {

/// CVODE's backward differentiation formulas (variable step and order), each step solved
/// for the acceleration (ImplicitAdapter). By default the order is at most 2. BDF 3 to 5
/// are unstable near the imaginary axis, where the eigenvalues of elastic rods lie, and
/// perform ten to a hundred times worse there. The option max_order 1 to 5 overrides.
///
/// `projection`: after each step q and v are projected onto g = 0 and g' = 0, and the
/// error estimate loses its part that violates them (Eich 1993; CVodeSetProjFn).
/// Hindmarsh et al., SUNDIALS, ACM TOMS 31(3), 2005.
class CvodeBdf final : public Cvode {
 public:
  /// Binds the method to a system, which must outlive it.
  CvodeBdf(System& system, const Options& options);

 private:
  ImplicitAdapter implicit_;
};

}  // namespace tress::integrators
