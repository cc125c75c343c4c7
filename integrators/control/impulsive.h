#pragma once

#include "contract/system.h"

namespace tress::integrators {

/// A method whose state may be changed between steps, as impulses do; an optional
/// capability of methods that solve for the state at the end of a step and keep none of
/// the steps before it.
class Impulsive {
 public:
  virtual ~Impulsive() = default;
  /// Goes on from (q, v) at the present time.
  virtual Status go_on(In q, In v) = 0;
  /// Whether System::solve() still solves with the matrix S(1, h, h^2) of the last step,
  /// one of h, provided that nobody else has linearized the system since.
  virtual bool has_matrix(double /*h*/) const { return false; }
};

}  // namespace tress::integrators
