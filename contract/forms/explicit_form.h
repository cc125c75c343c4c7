#pragma once

#include "contract/basics.h"

namespace tress {

/// a = a(t, q, v) at the cost of the model's own solve of M. For unconstrained systems
/// only.
class ExplicitForm {
 public:
  virtual ~ExplicitForm() = default;
  /// Computes the accelerations a (n).
  virtual Status acceleration(double t, In q, In v, Out a) noexcept = 0;
};

}  // namespace tress
