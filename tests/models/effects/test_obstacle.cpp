// The tangent planes at which points of strands touch rigid bodies during a step.
#include <gtest/gtest.h>

#include "models/effects/obstacle.h"

namespace tress::test_obstacle {

using namespace models;

std::shared_ptr<const RigidBody> ball(double radius,
                                      std::optional<RootMotion> head = {}) {
  return std::make_shared<RigidBody>(Sphere{radius},
                                     StrandPlace{{}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                     0, std::move(head));
}

TEST(Obstacle, IsMetOnTheSideFromWhichAPointCame) {
  const Obstacle obstacle(ball(2e-3), 0, 0.3);
  const Obstacle::Step step(obstacle, 0.1, 0.01);
  // Its centre lies behind the point at the end of the step.
  const Vec from{1e-4, 0, 2.5e-3}, to{1e-4, 0, -1e-3};
  const auto plane = step.touch(from, to, 0);
  ASSERT_TRUE(plane.has_value());
  EXPECT_NEAR(plane->normal.z, 1, 2e-3);
  EXPECT_NEAR(plane->gap(to), -3e-3, 1e-5);
  EXPECT_NEAR(plane->gap_before, norm(from) - 2e-3, 1e-15);
  // One that began inside leaves by the nearest way.
  const auto inside = step.touch({0, 0, -1.9e-3}, to, 0);
  ASSERT_TRUE(inside.has_value());
  EXPECT_LT(inside->normal.z, -0.99);
}

TEST(Obstacle, IsNoneBeyondItsReach) {
  const Obstacle obstacle(ball(2e-3), 1e-3, 0.3);
  const Obstacle::Step step(obstacle, 0.1, 0.01);
  const Vec far{5e-3, 0, 0};
  EXPECT_FALSE(step.touch(far, {3.01e-3, 0, 0}, 0).has_value());
  const auto near = step.touch(far, {3.01e-3, 0, 0}, 2e-5);
  ASSERT_TRUE(near.has_value());
  EXPECT_NEAR(near->gap({3.01e-3, 0, 0}), 1e-5, 1e-12);
  EXPECT_EQ(norm(near->velocity), 0);
}

TEST(Obstacle, CarriesPointsAsItTurns) {
  RootMotion head;
  head.rotations.push_back({{0, 0, 1}, [](double t) {
                              return SignalValue{2 * t, 2, 0};
                            }});
  const Obstacle obstacle(ball(2e-3, head), 0, 0.3);
  const double h = 0.01;
  const Obstacle::Step step(obstacle, 0.1, h);
  const Vec from{2e-3, 0, 0}, to{1.9e-3, 0, 0};
  const auto plane = step.touch(from, to, 0);
  ASSERT_TRUE(plane.has_value());
  // As far as the surface goes, not along its velocity at the end.
  const Vec there = rotation({0, 0, 1}, 2 * h) * from;
  EXPECT_LT(norm(from + h * plane->velocity - there), 1e-15);
}

}  // namespace tress::test_obstacle
