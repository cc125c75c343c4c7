// The signed distance to closed surfaces of triangles, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "models/mesh/closed_surface.h"
#include "tests/models/effects/cloud.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/support/refusal.h"

namespace tress::test_closed_surface {

using namespace models;
using testing_support::ball;
using testing_support::Cloud;
using testing_support::cube;
using testing_support::refusal;

constexpr double eps = std::numeric_limits<double>::epsilon();

double to_cube(const Vec& x, double a) {
  const Vec q{std::abs(x.x) - a, std::abs(x.y) - a, std::abs(x.z) - a};
  const Vec out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return norm(out) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

// Coordinates below 2; a distance is a few dozen operations and one root.
TEST(ClosedSurface, FindsTheDistanceFromACube) {
  const ClosedSurface surface(cube(0.5), "test");
  EXPECT_NEAR(surface.volume(), 1, 64 * eps);
  int inside = 0;
  const Cloud cloud(2000);
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    const Vec x = load3(&cloud.x[3 * i]);
    EXPECT_NEAR(surface.distance(x), to_cube(x, 0.5), 64 * eps);
    inside += surface.distance(x) < 0;
  }
  EXPECT_GT(inside, 20);
  // Nearest to a corner, to an edge, and on the surface itself.
  EXPECT_NEAR(surface.distance({1, 1, 1}), std::sqrt(0.75), 8 * eps);
  EXPECT_NEAR(surface.distance({1, 0.1, 1}), std::sqrt(0.5), 8 * eps);
  EXPECT_NEAR(surface.distance({0.5, 0.2, 0.1}), 0, 8 * eps);
}

// The faces of a ball of n halvings lie below the sphere by the sagitta of its longest
// edge, e^2/(8 r) for an edge and e^2/(6 r) for the centre of a triangle.
TEST(ClosedSurface, FindsTheDistanceFromABall) {
  const TriangleMesh mesh = ball(0.6, 4);
  double edge = 0;
  for (const auto& t : mesh.triangle) {
    edge = std::max(edge, norm(mesh.corner[t[0]] - mesh.corner[t[1]]));
  }
  const double below = edge * edge / (6 * 0.6);
  const ClosedSurface surface(mesh, "test");
  const Cloud cloud(500);
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    const Vec x = load3(&cloud.x[3 * i]);
    const double d = surface.distance(x), sphere = norm(x) - 0.6;
    EXPECT_GE(d, sphere - 16 * eps);
    EXPECT_LE(d, sphere + 1.2 * below);
  }
}

TEST(ClosedSurface, TurnsNormalsOutwards) {
  TriangleMesh mesh = cube(0.5);
  for (auto& t : mesh.triangle) std::swap(t[0], t[1]);
  const ClosedSurface surface(mesh, "test");
  EXPECT_NEAR(surface.distance({}), -0.5, 8 * eps);
  EXPECT_NEAR(surface.distance({0, 0, 1}), 0.5, 8 * eps);
}

// Corners of one place become one: a file of loose triangles is closed.
TEST(ClosedSurface, JoinsCornersOfOnePlace) {
  const TriangleMesh whole = cube(0.5);
  TriangleMesh loose;
  for (const auto& t : whole.triangle) {
    const std::size_t first = loose.corner.size();
    for (const std::size_t i : t) loose.corner.push_back(whole.corner[i]);
    loose.triangle.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(ClosedSurface(loose, "test").mesh().corner.size(), 8U);
}

TEST(ClosedSurface, RefusesWhatIsNotClosed) {
  const auto refused = [](const TriangleMesh& mesh) {
    return refusal([&] { ClosedSurface(mesh, "cube.obj"); });
  };
  TriangleMesh open = cube(0.5);
  open.triangle.pop_back();
  EXPECT_EQ(refused(open),
            "the mesh has holes: 3 edges belong to one triangle only, one at (0.5, 0.5, "
            "0.5) m (cube.obj): close it in the program that wrote it");
  TriangleMesh mixed = cube(0.5);
  std::swap(mixed.triangle[5][0], mixed.triangle[5][1]);
  EXPECT_NE(refused(mixed).find("let all triangles face outwards"), std::string::npos);
  TriangleMesh broken = cube(0.5);
  broken.corner[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refused(broken).find("not finite"), std::string::npos);
  EXPECT_NE(refused({}).find("fewer than four triangles"), std::string::npos);
}

}  // namespace tress::test_closed_surface
