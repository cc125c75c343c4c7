#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/catalogue_cases.h"

/// A system's tangent against central differences of its residual.
namespace tress::testing_support {

using namespace models;

// One time off the start, so that time-dependent terms are alive.
inline constexpr double t0 = 0.013;

inline std::vector<double> residual(System& system, const std::vector<double>& q,
                                    const std::vector<double>& v,
                                    const std::vector<double>& a) {
  std::vector<double> r(q.size());
  EXPECT_EQ(system.residual(t0, q, v, a, r), Status::ok);
  return r;
}

/// Length of the direction x against the system's scales.
inline double direction_length(const States& s, Weights w, const std::vector<double>& x) {
  double length = 0;
  for (std::size_t i = 0; i < s.n; ++i) {
    length = std::max({length, std::abs(w.pos * x[i]) / s.q_typ[i],
                       std::abs(w.vel * x[i]) / s.v_typ[i],
                       std::abs(w.acc * x[i]) / s.a_typ[i]});
  }
  return length;
}

/// S(w) x by central differences of the residual over so much of the system's scales.
inline std::vector<double> tangent_product(System& system, const States& s, Weights w,
                                           const std::vector<double>& x,
                                           double over = difference_step) {
  const double e = over / direction_length(s, w, x);
  return central_difference(e, [&](double step) {
    return residual(system, plus(s.q, step * w.pos, x), plus(s.v, step * w.vel, x),
                    plus(s.a, step * w.acc, x));
  });
}

/// What rounding of the residual makes of it, eps |r| over the step, ten times: forces of
/// stiff springs may be a million times what the masses answer.
inline double tangent_rounding(System& system, const States& s, Weights w,
                               const std::vector<double>& x,
                               double over = difference_step) {
  const double e = over / direction_length(s, w, x);
  return 10 * 2.2e-16 * largest(residual(system, s.q, s.v, s.a)) / e;
}

/// |S x - b| / |b| for x from linearize and solve, with b the image of a random vector;
/// without what rounding explains.
inline double tangent_error(System& tangent_of, System& residual_of, States& s, Weights w,
                            double over = difference_step) {
  const std::vector<double> y = s.random(s.a_typ);
  const std::vector<double> b = tangent_product(residual_of, s, w, y, over);
  EXPECT_EQ(tangent_of.linearize(t0, s.q, s.v, s.a, w), Status::ok);
  std::vector<double> x(s.n);
  EXPECT_EQ(tangent_of.solve(b, x), Status::ok);
  const double off = largest(plus(tangent_product(residual_of, s, w, x, over), -1, b));
  const double rounding = tangent_rounding(residual_of, s, w, x, over) +
                          tangent_rounding(residual_of, s, w, y, over);
  return std::max(0.0, off - rounding) / largest(b);
}

// Truncation e^4 = 3e-13 times the ratio of fifth to first derivatives: 1e-7 leaves five
// digits for it, and for the rounding of sums inside the residual.
inline constexpr double tangent_tolerance = 1e-7;

}  // namespace tress::testing_support
