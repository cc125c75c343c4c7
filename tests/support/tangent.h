#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/catalogue_cases.h"

/// A system's tangent against central differences of its residual.
namespace tress::testing_support {

// One time off the start, so that time-dependent terms are alive.
inline constexpr double t0 = 0.013;

inline std::vector<double> residual(System& system, const std::vector<double>& q,
                                    const std::vector<double>& v,
                                    const std::vector<double>& a) {
  std::vector<double> r(q.size());
  EXPECT_EQ(system.residual(t0, q, v, a, r), Status::ok);
  return r;
}

/// S(w) x by central differences of the residual.
inline std::vector<double> tangent_product(System& system, const States& s, Weights w,
                                           const std::vector<double>& x) {
  double length = 0;
  for (std::size_t i = 0; i < s.n; ++i) {
    length = std::max({length, std::abs(w.pos * x[i]) / s.q_typ[i],
                       std::abs(w.vel * x[i]) / s.v_typ[i],
                       std::abs(w.acc * x[i]) / s.a_typ[i]});
  }
  return central_difference(difference_step / length, [&](double e) {
    return residual(system, plus(s.q, e * w.pos, x), plus(s.v, e * w.vel, x),
                    plus(s.a, e * w.acc, x));
  });
}

/// |S x - b| / |b| for x from linearize and solve, with b the image of a random vector.
inline double tangent_error(System& tangent_of, System& residual_of, States& s,
                            Weights w) {
  const std::vector<double> b = tangent_product(residual_of, s, w, s.random(s.a_typ));
  EXPECT_EQ(tangent_of.linearize(t0, s.q, s.v, s.a, w), Status::ok);
  std::vector<double> x(s.n);
  EXPECT_EQ(tangent_of.solve(b, x), Status::ok);
  const std::vector<double> sx = tangent_product(residual_of, s, w, x);
  return largest(plus(sx, -1, b)) / largest(b);
}

// Truncation e^4 = 3e-13 times the ratio of fifth to first derivatives, plus rounding
// eps / e = 3e-13 times the ratio of |r| to |S x|: 1e-7 leaves five digits for both
// ratios.
inline constexpr double tangent_tolerance = 1e-7;

}  // namespace tress::testing_support
