#pragma once

#include "integrators/formulation/dynamics.h"

namespace tress::integrators {

/// Mass-orthogonal projection of a state onto g = 0 and g' = 0:
///     M dq = G^T mu, g(q + dq) = 0   and   M dv = G^T nu, G (v + dv) + g_t = 0.
/// One factorisation at the incoming q serves both, by simplified Newton iterations.
class Projection {
 public:
  /// Works on `dynamics`, which must outlive it.
  explicit Projection(Dynamics& dynamics);

  /// `retry` when the iteration does not reach the rounding level of g.
  Status project(double t, InOut q, InOut v) noexcept;

  /// The two parts of project() separately, with the factorisation held by `dynamics`.
  Status positions(double t, InOut q) noexcept;
  /// Projects the velocities, with the factorisation of positions().
  Status velocities(double t, In q, InOut v) noexcept;

 private:
  Dynamics& dynamics_;
  std::vector<double> step_, g_, zero_;
};

}  // namespace tress::integrators
