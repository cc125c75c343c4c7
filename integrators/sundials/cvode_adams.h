#pragma once

#include "integrators/sundials/cvode.h"

namespace tress::integrators {

/// CVODE's Adams-Moulton formulas of order 1 to 12 (variable step and order), solved by
/// fixed-point iteration: no Newton matrix, so the step is limited by the fastest mode.
/// Hindmarsh et al., SUNDIALS, ACM TOMS 31(3), 2005. O(n) per step and order.
class CvodeAdams final : public Cvode {
 public:
  /// Binds the method to a system, which must outlive it.
  CvodeAdams(System& system, const Options& options);

 private:
  NonlinearSolver fixed_point_;
};

}  // namespace tress::integrators
