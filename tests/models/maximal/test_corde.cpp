#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "models/quaternion_rods/corde_edge.h"
#include "tests/models/maximal/quaternion_rods.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"

namespace tress::test_corde {

using namespace simulation;

using namespace testing_support;

// Half turns about the axes have one entry of q each.
TEST(Quaternion, HasTheAxesOfItsFrame) {
  for (const Vec& axis :
       {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}, Vec{0.48, 0.6, 0.64}}) {
    for (const double angle : {0.0, 0.3, -2.0, 3.14159, std::numbers::pi}) {
      const Frame frame = rotation(axis, angle);
      const Quaternion q = quaternion_of(frame);
      EXPECT_NEAR(dot(q, q), 1, 1e-15);
      // q v conj(q) for the second axis.
      const Quaternion e1 = q * (Quaternion{0, {0, 1, 0}} * Quaternion{q.w, -1.0 * q.v});
      const Vec off[] = {first_axis(q) - frame.e0, e1.v - frame.e1};
      for (const Vec& d : off) EXPECT_LE(norm(d), 4e-16 * 4);
      const Vec turn = turn_between(quaternion_of({}), nearer({}, q));
      EXPECT_NEAR(norm(turn), 2 * std::sin(std::abs(angle) / 2), 1e-15 * 4);
    }
  }
}

TEST(Corde, ForcesAreTheGradientOfTheEnergy) {
  expect_forces_of_energy(CordeEdge{1, {2, 0.7, 0.7, 0.7, 0.9}, {}});
}

TEST(Corde, TangentIsExactWithFrictionOfStretch) {
  const auto system =
      make_model("corde", {{"elements", "6"}, {"stretch_friction_n_s", "1e-3"}});
  States s(*system);
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
    s.shake(0.05);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance);
  }
}

// Of a light cantilever edges lag behind frames by V/kappa = Gamma (1 - s) h^2/coupling:
// the tip hangs Gamma h^2/(2 coupling) lower, of Gamma/8.
TEST(Corde, CouplingLowersTheTipByItsShear) {
  const Master light{0.1, 0.99991072, 0.01249843798};
  const auto height = [&](const char* coupling, int n) {
    const Hung hung =
        hang("corde",
             with(thin_rod, {{"coupling", coupling}, {"elements", std::to_string(n)}}),
             light.gamma / line_density, at_rest);
    return -points(hung).back();
  };
  for (const int n : {5, 10, 20}) {
    const double h = 1.0 / n;
    const double lowered = height("100", n) - height("10000", n);
    // 1e-3 for the weight's own nonlinearity, (Gamma/8)^2 times some number of order one.
    EXPECT_NEAR(lowered / (light.gamma / 8) / (4 * h * h * (0.01 - 0.0001)), 1, 1e-3);
  }
}

}  // namespace tress::test_corde
