#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "contract/forms/explicit_form.h"
#include "integrators/catalogue.h"
#include "models/reduced/free_root.h"
#include "simulation/run/simulation.h"
#include "tests/support/tangent.h"

namespace tress::test_free_root {

using namespace models;
using namespace simulation;

void expect_near(const Vec& a, const Vec& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// The motion is the same before and after the reference moves, to the rounding of
// rotations; turns about different axes, which do not commute, follow one another.
TEST(FreeRoot, MotionDoesNotChangeWhenTheReferenceMoves) {
  FreeRoot start;
  start.frame = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  FreeRootFrame root(start);
  const std::array a{0.3, -0.1, 0.2, 1.0, -2.0, 0.5};
  for (const Vec& theta : {Vec{1.2, -0.9, 0.8}, Vec{-0.2, 1.6, 0.4}}) {
    std::array q{0.1, -0.2, 0.3, theta.x, theta.y, theta.z};
    std::array v{0.4, 0.5, -0.6, 0.7, 0.3, -1.1};
    root.place(q);
    const FrameMotion before = root.motion(q, v, a);
    ASSERT_TRUE(root.rebase(q, v));
    EXPECT_EQ(q[3], 0);
    root.place(q);
    const FrameMotion after = root.motion(q, v, a);
    constexpr double rounding = 1e-14;
    expect_near(after.frame.e0, before.frame.e0, rounding);
    expect_near(after.frame.e1, before.frame.e1, rounding);
    expect_near(after.frame.e2, before.frame.e2, rounding);
    expect_near(after.x, before.x, 0);
    expect_near(after.v, before.v, rounding);
    expect_near(after.omega, before.omega, rounding);
  }
}

TEST(FreeRoot, ReferenceStaysWhileTheAngleIsSmall) {
  FreeRootFrame root{FreeRoot{}};
  std::array q{0.0, 0.0, 0.0, 0.4, 0.0, 0.3}, v{0.0, 0.0, 0.0, 1.0, 2.0, 3.0};
  EXPECT_FALSE(root.rebase(q, v));
  EXPECT_EQ(q[3], 0.4);
}

std::unique_ptr<System> thrown_chain(const ModelSettings& more = {}) {
  ModelSettings settings = {
      {"elements", "6"},           {"motion", "free"},
      {"gravity_m_s2", "0"},       {"drag_kg_m_s", "1e-5"},
      {"root_tangent", "x"},       {"natural_curvature_per_m", "20"},
      {"natural_twist_per_m", "5"}};
  settings.insert(settings.end(), more.begin(), more.end());
  return make_model("articulated_chain", settings);
}

// Its mass matrix is singular: of a frame that has no mass, and turns.
TEST(FreeChain, TangentIsTheDerivativeOfTheResidual) {
  for (const char* modes : {"bend_twist", "bend"}) {
    const auto system = thrown_chain({{"modes", modes}, {"jacobian", "exact"}});
    EXPECT_FALSE(system->traits().regular_mass);
    EXPECT_EQ(system->explicit_form(), nullptr);
    testing_support::States s(*system);
    for (const double h : {1e-3, 1.0 / 30}) {
      s.shake(0.05);
      EXPECT_LE(testing_support::tangent_error(*system, *system, s, {1, h, h * h}),
                testing_support::tangent_tolerance)
          << modes << " " << h;
    }
  }
}

// No moment acts on the frame, so none does on the first joint, which stays as it is at
// rest, to what Newton's method leaves of the equations; the others do not.
TEST(FreeChain, FirstLinkMovesAsTheRoot) {
  const auto system = thrown_chain();
  Options options;
  options.step = 1e-3;
  const auto method = integrators::make_integrator("backward_euler", *system, options);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n);
  system->initial_state(q, v);
  const std::vector<double> start = q;
  ASSERT_EQ(method->start(0, q, v), Status::ok);
  ASSERT_EQ(method->advance(0.1), Status::ok);
  double first = 0, others = 0, turned = 0;
  for (std::size_t i = 0; i < 18; ++i) {
    const double change = std::abs(method->q()[i] - start[i]);
    (i < 3 ? first : others) = std::max(i < 3 ? first : others, change);
  }
  for (std::size_t i = n - 3; i < n; ++i) {
    turned = std::max(turned, std::abs(method->q()[i]));
  }
  EXPECT_LE(first, 1e2 * options.newton_tolerance);
  EXPECT_GT(others, 1e-3);
  EXPECT_GT(turned, 0.1);
}

}  // namespace tress::test_free_root
