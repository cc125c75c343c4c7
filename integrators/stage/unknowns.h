#pragma once

#include <cstddef>
#include <vector>

#include "integrators/formulation/dynamics.h"
#include "linear/vector_ops.h"

namespace tress::integrators {

/// The unknowns of a stage, or a change of them: accelerations (n) and multipliers (m).
struct Unknowns {
  /// Allocates for a system; all zero.
  explicit Unknowns(const Dynamics& dynamics)
      : a(size(dynamics.n())), lambda(size(dynamics.m())) {}

  std::vector<double> a, lambda;  // accelerations (n), multipliers (m)

  /// Becomes x + factor d; both may be this one.
  void become(const Unknowns& x, double factor, const Unknowns& d) noexcept {
    shifted(a, x.a, factor, d.a);
    shifted(lambda, x.lambda, factor, d.lambda);
  }
};

}  // namespace tress::integrators
