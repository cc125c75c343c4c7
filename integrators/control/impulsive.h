#pragma once

#include "contract/basics.h"

namespace tress::integrators {

/// Method whose state may be changed between steps, as impulses do. Optional capability
/// of methods that solve for the state at the end of a step and use no earlier steps.
class Impulsive {
 public:
  virtual ~Impulsive() = default;
  /// Goes on from (q, v) at the present time.
  virtual Status go_on(In q, In v) = 0;
  /// Somebody else has used the system's matrix since the last step.
  virtual void lose_matrix() = 0;
};

}  // namespace tress::integrators
