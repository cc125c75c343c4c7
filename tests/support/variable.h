#pragma once

#include <cstddef>

#include "math/dual.h"

namespace tress::testing_support {

/// x as the i-th of n independent variables, for first derivatives.
template <int n>
Dual<n> variable(double x, std::size_t i) {
  Dual<n> r(x);
  r.part[i] = 1;
  return r;
}

template <int n>
using Dual2 = Dual<n, Dual<n>>;

/// The same for second derivatives too.
template <int n>
Dual2<n> variable2(double x, std::size_t i) {
  Dual2<n> r(variable<n>(x, i));
  r.part[i] = 1;
  return r;
}

}  // namespace tress::testing_support
