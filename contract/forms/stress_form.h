#pragma once

#include "contract/basics.h"

namespace tress {

/// Stresses of stiff strains s(q) as unknowns of Newton's method beside q, condensed
/// [Magisano, Leonetti, Garcea 2017, CMAME 313, 986, "mixed integration points"]. The
/// tangent of r = k s ds/dq has a term of second order, stress d^2 s/dq^2, with the
/// stress k s of the state at which it is evaluated. A correction that turns an edge by x
/// leaves it longer by x^2/2 of its length, so that a stiff one has a stress there that
/// the solution does not have: it makes the next correction take back the one before. The
/// stress that the linear equations themselves have found is free of that.
class StressForm {
 public:
  virtual ~StressForm() = default;
  enum class Stresses {
    held,      // those at the origin
    followed,  // with their change linear in that of q since: what a correction from the
               // origin found
  };
  /// From where the terms of second order of the next linearize() or SparseForm::values()
  /// have their stresses; all others have those of their own state, as the derivative of
  /// the residual does.
  virtual void take_stresses(double t, In q, Stresses stresses) noexcept = 0;
};

}  // namespace tress
