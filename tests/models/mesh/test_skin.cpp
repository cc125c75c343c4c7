// Roots on surfaces that deform.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "models/motion/skin.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/support/refusal.h"

namespace tress::test_skin {

using namespace models;
using testing_support::ball;
using testing_support::refusal;

const std::vector<double> times{0, 0.1, 0.25, 0.4};

/// A ball turned about an axis and carried away, by the angle and way of each time.
std::vector<TriangleMesh> turning(const Vec& axis, const std::vector<double>& angles,
                                  const Vec& way) {
  std::vector<TriangleMesh> frames;
  for (const double angle : angles) {
    TriangleMesh mesh = ball(0.1, 3);
    for (Vec& x : mesh.corner) x = rotation(axis, angle) * x + angle * way;
    frames.push_back(mesh);
  }
  return frames;
}

// At the times of the frames a root is where the rigid motion of the surface takes it:
// some hundred operations on numbers up to 1.
TEST(Skin, CarriesARootAsARigidSurfaceAtItsFrames) {
  const double round = 1e3 * std::numeric_limits<double>::epsilon();
  const std::vector<double> angles{0, 0.4, -0.3, 1.2};
  for (const Vec& axis : {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0.6, 0, 0.8}}) {
    const Skin skin(turning(axis, angles, {0.1, 0.2, -0.3}), times, "skin");
    for (const Vec& at : {Vec{0.06, 0.08, 0.03}, Vec{-0.02, 0.03, -0.11}}) {
      const Frame frame = rotation({0, 0.6, 0.8}, 0.7);
      const RootMotion motion = skin.motion(at, frame);
      for (std::size_t i = 0; i < times.size(); ++i) {
        const RootPose now = motion.at(times[i]);
        const Frame turn = rotation(axis, angles[i]);
        EXPECT_LE(norm(now.x - (turn * at + angles[i] * Vec{0.1, 0.2, -0.3})), round);
        EXPECT_LE(norm(now.frame.e0 - turn * frame.e0), round);
        EXPECT_LE(norm(now.frame.e2 - turn * frame.e2), round);
      }
      const RootPose after = motion.at(1);
      EXPECT_LE(norm(after.v) + norm(after.omega) + norm(after.a), round);
    }
  }
}

// Velocities are the derivatives of places: a difference over 2e-6 s errs by its square
// times a third derivative (below 1e5 m/s^3 here), and by rounding, 1e-16/1e-6.
TEST(Skin, MovesAtTheRateOfItsPlaces) {
  const Skin skin(turning({0.6, 0, 0.8}, {0, 0.4, -0.3, 1.2}, {0.1, 0, 0}), times,
                  "skin");
  const RootMotion motion = skin.motion({0.06, 0.08, 0.03}, Frame{});
  for (const double t : {0.04, 0.17, 0.31}) {
    const double h = 1e-6;
    const RootPose before = motion.at(t - h), now = motion.at(t),
                   after = motion.at(t + h);
    EXPECT_GT(norm(now.v), 0.1);
    EXPECT_LE(norm((1 / (2 * h)) * (after.x - before.x) - now.v), 1e-6);
    EXPECT_LE(norm((1 / (2 * h)) * (after.v - before.v) - now.a), 1e-4);
    EXPECT_LE(norm((1 / (2 * h)) * (after.frame.e1 - before.frame.e1) -
                   cross(now.omega, now.frame.e1)),
              1e-6);
  }
}

/// A jaw: what is below a plane turns about an axis in it.
TEST(Skin, LeavesPartsInPlaceThatDoNotMove) {
  std::vector<TriangleMesh> frames;
  for (const double angle : {0.0, 0.1, 0.3, 0.2}) {
    TriangleMesh mesh = ball(0.1, 4);
    for (Vec& x : mesh.corner) {
      if (x.z < -0.02) x = rotation({0, 1, 0}, angle) * x;
    }
    frames.push_back(mesh);
  }
  const Skin skin(frames, times, "skin");
  const Frame frame;
  const RootMotion above = skin.motion({0.06, 0, 0.08}, frame),
                   below = skin.motion({0.06, 0, -0.08}, frame);
  for (const double t : {0.07, 0.25, 0.31}) {
    EXPECT_LE(norm(above.at(t).x - Vec{0.06, 0, 0.08}), 1e-15);
    EXPECT_LE(norm(above.at(t).omega), 1e-12);
  }
  const Vec turned = rotation({0, 1, 0}, 0.3) * Vec{0.06, 0, -0.08};
  EXPECT_LE(norm(below.at(0.25).x - turned), 1e-14);
}

TEST(Skin, JumpsBetweenFramesWithTheSameTime) {
  const std::vector<double> jumping{0, 0.1, 0.1, 0.4};
  const std::vector<double> angles{0, 0.4, -0.3, 1.2};
  const Skin skin(turning({0, 0, 1}, angles, {0.1, 0.2, -0.3}), jumping, "skin");
  const Vec at{0.06, 0.08, 0.03};
  const RootMotion motion = skin.motion(at, Frame{});
  ASSERT_EQ(motion.teleports.size(), 1u);
  const auto place = [&](double angle) {
    return rotation({0, 0, 1}, angle) * at + angle * Vec{0.1, 0.2, -0.3};
  };
  EXPECT_LE(norm(motion.at(0.1).x - place(-0.3)), 1e-13);
  EXPECT_LE(norm(motion.at(std::nextafter(motion.teleports[0], 0.0)).x - place(0.4)),
            1e-13);
}

TEST(Skin, RefusesFramesThatDoNotMatch) {
  const auto refused = [](std::vector<TriangleMesh> frames, std::vector<double> at) {
    return refusal([&] { Skin(std::move(frames), std::move(at), "[root]"); });
  };
  std::vector<TriangleMesh> two(2, ball(0.1, 0));
  EXPECT_EQ(refused(two, {0, 1}), "");
  EXPECT_NE(refused(two, {0}).find("2 meshes for 1 times"), std::string::npos);
  EXPECT_NE(refused(two, {0.5, 0.4}).find("sort the meshes by time"), std::string::npos);
  two[1].triangle.pop_back();
  EXPECT_NE(refused(two, {0, 1}).find("mesh 1 of the skin has other triangles"),
            std::string::npos);
  two[1] = two[0];
  two[1].corner[2] = two[1].corner[0];
  EXPECT_NE(refused(two, {0, 1}).find("without area"), std::string::npos);
}

}  // namespace tress::test_skin
