#pragma once

#include "contract/basics.h"

namespace tress {

/// Stresses of stiff strains s(q) as unknowns of Newton's method in addition to q,
/// condensed [Magisano, Leonetti, Garcea 2017, CMAME 313, 986, "mixed integration
/// points"]. The tangent of r = k s ds/dq has a second-order term, stress d^2 s/dq^2,
/// with the stress k s of its state. A correction that turns an edge by x lengthens the
/// edge by x^2/2 of its length. A stiff edge then has a stress that the solution does not
/// have, so that the next correction reverts the last one. The stress that the linear
/// equations themselves give does not have this error.
class StressForm {
 public:
  virtual ~StressForm() = default;
  /// State whose stresses the second-order terms use.
  enum class Stresses {
    held,      // those at the origin
    followed,  // with their change linear in that of q since: what a correction from the
               // origin found
  };
  /// Selects the stresses in the second-order terms of the next linearize() or
  /// SparseForm::values(). All other terms use the stresses of their own state, as the
  /// derivative of the residual does.
  virtual void take_stresses(double t, In q, Stresses stresses) noexcept = 0;
};

}  // namespace tress
