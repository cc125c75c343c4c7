#include <gtest/gtest.h>

#include <array>

#include "models/reduced/free_root.h"

namespace tress::test_free_root {

using namespace models;

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

}  // namespace tress::test_free_root
