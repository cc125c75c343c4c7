#pragma once

#include <algorithm>
#include <vector>

#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {

/// One linearly implicit step: S(1, h, h^2) a = -r(a = 0) at (q + h v, v), then v + h a
/// and q + h (v + h a). S is evaluated at the last acceleration, zero at the start. At a
/// = 0 an exact Jacobian would have the geometric stiffness of a strand that does not
/// accelerate. That makes a shaken strand less stable than omitting the geometric
/// stiffness.
class LinearlyImplicitStep {
 public:
  /// Works on `dynamics`, which must outlive it.
  LinearlyImplicitStep(Dynamics& dynamics, const Options& options)
      : stage_(dynamics, options),
        a_(static_cast<std::size_t>(dynamics.n())),
        a_last_(a_.size()),
        q_bar_(a_.size()) {}

  /// Forgets the last acceleration.
  void reset() { std::ranges::fill(a_, 0.0); }

  /// Steps from (q, v) at time t to q(), v() at t + h.
  Status take(double t, double h, In q, In v, InOut lambda) noexcept {
    shifted(q_bar_, q, h, v);
    std::swap(a_, a_last_);
    std::ranges::fill(a_, 0.0);
    return stage_.single_step(t + h, q_bar_, v, {1, h, h * h}, a_last_, a_, lambda);
  }
  /// Returns the coordinates after take().
  In q() const { return stage_.q(); }
  /// Returns the rates after take().
  In v() const { return stage_.v(); }

 private:
  Stage stage_;
  std::vector<double> a_, a_last_, q_bar_;
};

}  // namespace tress::integrators
