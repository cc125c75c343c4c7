#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "models/strand/points_along.h"
#include "simulation/run/tip_paths.h"
#include "simulation/scene/scene.h"

namespace tress::test_points_along {

using namespace simulation;

TEST(PointsAlong, AreExactOnCubics) {
  const std::vector<double> s{0, 0.1, 0.3, 0.4, 0.7, 1};
  const auto cubic = [](double u) { return 1 + u - 3 * u * u + 2 * u * u * u; };
  std::vector<double> x;
  for (const double u : s) x.insert(x.end(), {cubic(u), u, 0});
  for (const double u : {0.0, 0.05, 0.3, 0.61, 0.99, 1.0}) {
    const models::PointBetween point = models::point_between(u, s);
    // Weights are below 10, products of at most six rounded factors.
    EXPECT_NEAR(point.at(x.data(), 0), cubic(u), 1e-14);
    EXPECT_NEAR(point.at(x.data(), 1), u, 1e-14);
  }
}

TEST(GroupedDistance, IsTheLargestInAGroupAndRmsOverGroups) {
  const std::vector<double> a(12), b{3, 4, 0, 1, 0, 0, 0, 0, 1, 0, 12, 5};
  EXPECT_DOUBLE_EQ(grouped_distance(a, b, 2), std::sqrt((25. + 169) / 2));
  EXPECT_DOUBLE_EQ(grouped_distance(a, b, 1), std::sqrt((25. + 1 + 1 + 169) / 4));
  EXPECT_TRUE(std::isinf(grouped_distance(a, {b.data(), 6}, 1)));
  std::vector<double> lost = b;
  lost[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(grouped_distance(a, lost, 2)));
}

TEST(TipPaths, MayBeOfPointsAlongTheStrands) {
  const Scene scene = parse_scene(R"(
title = "falls"
duration_s = 0.04
frames_per_s = 50
[model]
id = "der"
[integrator]
id = "backward_euler"
dt_s = 0.002
[strand]
elements = 8
root_tangent = [1, 0, 0]
[effects.gravity]
)",
                                  "falls.toml");
  const TipPaths tips = tip_paths(scene, 0);
  const TipPaths along = tip_paths(scene, 0, {}, {.parts = 4});
  EXPECT_EQ(tips.group, 1u);
  EXPECT_EQ(along.group, 5u);
  ASSERT_EQ(tips.x.size(), 9u);
  ASSERT_EQ(along.x.size(), 45u);
  for (std::size_t frame = 0; frame < 3; ++frame) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_DOUBLE_EQ(along.x[15 * frame + 12 + axis], tips.x[3 * frame + axis]);
      EXPECT_EQ(along.x[15 * frame + axis], along.x[axis]);  // the clamp
    }
  }
}

}  // namespace tress::test_points_along
