#include <gtest/gtest.h>

#include <numbers>

#include "models/contact/body_shapes.h"
#include "tests/models/effects/cloud.h"

namespace tress::test_body_shapes {

using namespace models;

using testing_support::Cloud;

constexpr double eps = std::numeric_limits<double>::epsilon();

const Sphere sphere{0.6};
const Capsule capsule{0.4, 0.5};
const Ellipsoid ellipsoid({0.5, 0.9, 0.7});
const Ellipsoid flat({0.9, 0.9, 0.1});
const Ellipsoid needle({0.05, 0.05, 1});

/// Gradient of length 1, and both derivatives against central differences at 300 points
/// in and around the shape. The derivatives of phi grow as its radius of curvature
/// shrinks, to no less than `apart` from centres and edges where they do not exist: third
/// ones are below 3/apart^2 and fourth ones below 15/apart^3 [of r, the worst of all], so
/// that differences err by h^2/6 times those and by some ten eps/h.
template <class Shape>
void expect_consistent(const Shape& shape, double apart, auto far_from_edges) {
  constexpr double h = 1e-5;
  const double of_value = h * h / 2 / (apart * apart) + 10 * eps / h;
  const double of_gradient =
      h * h * 15 / 6 / (apart * apart * apart) + 10 * eps / (h * apart);
  const Cloud cloud(300);
  int tested = 0;
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    const Vec x = load3(&cloud.x[3 * i]);
    const Distance at = shape.distance(x);
    EXPECT_NEAR(norm(at.gradient), 1, 8 * eps);
    if (!far_from_edges(x)) continue;
    ++tested;
    const Mat3 curvature = shape.curvature(x);
    for (const Vec& e : {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}}) {
      const Distance above = shape.distance(x + h * e), below = shape.distance(x - h * e);
      EXPECT_NEAR(dot(at.gradient, e), (above.value - below.value) / (2 * h), of_value);
      const Vec difference = 1 / (2 * h) * (above.gradient - below.gradient);
      EXPECT_LE(norm(curvature * e - difference), of_gradient) << i;
    }
  }
  EXPECT_GT(tested, 100);
}

TEST(BodyShapes, SphereIsConsistent) {
  expect_consistent(sphere, 0.1, [](const Vec& x) { return norm(x) > 0.1; });
}

TEST(BodyShapes, CapsuleIsConsistent) {
  expect_consistent(capsule, 0.1, [](const Vec& x) {
    return std::hypot(x.x, x.y) > 0.1 && std::abs(std::abs(x.z) - 0.5) > 1e-3;
  });
}

// Centres of curvature lie inside; out to half the least radius of curvature, 0.5^2/0.9,
// below the surface the distance to them is more than 0.13.
TEST(BodyShapes, EllipsoidIsConsistent) {
  expect_consistent(ellipsoid, 0.13,
                    [](const Vec& x) { return ellipsoid.distance(x).value > -0.138; });
}

TEST(BodyShapes, CurvatureOfAnEllipsoidInsideIsThatOfItsDistance) {
  // Down the x axis from its end, where the radii of curvature are b^2/a and c^2/a.
  const double b = 0.9 * 0.9 / 0.5, c = 0.7 * 0.7 / 0.5;
  for (const double x : {0.1, 0.3, 0.5, 0.9}) {
    const double phi = x - 0.5;
    EXPECT_NEAR(ellipsoid.distance({x, 0, 0}).value, phi, 4 * eps);
    const Mat3 k = ellipsoid.curvature({x, 0, 0});
    EXPECT_NEAR(k.r1.y, 1 / (b + phi), 50 * eps);
    EXPECT_NEAR(k.r2.z, 1 / (c + phi), 50 * eps);
    EXPECT_NEAR(k.r0.x, 0, 50 * eps);
  }
}

/// Points of the surface of an ellipsoid, n^2 of them.
std::vector<Vec> surface(const Vec& a, int n) {
  using std::numbers::pi;
  std::vector<Vec> all;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = pi * (i + 0.5) / n, v = 2 * pi * j / n;
      all.push_back({a.x * std::sin(u) * std::cos(v), a.y * std::sin(u) * std::sin(v),
                     a.z * std::cos(u)});
    }
  }
  return all;
}

TEST(BodyShapes, NoPointOfAnEllipsoidIsNearerThanTheNearest) {
  for (const Ellipsoid& shape : {ellipsoid, flat, needle}) {
    const Vec a = shape.half_axes();
    const auto points = surface(a, 60);
    const Cloud cloud(200);
    for (std::size_t i = 0; i < 200; ++i) {
      Vec x = load3(&cloud.x[3 * i]);
      if (i % 4 == 0) x.x = 0;
      if (i % 8 == 0) x.y = 0;
      if (i % 5 == 0) x.z = 0;
      if (i % 3 == 0) x = 0.3 * Vec{a.x * x.x, a.y * x.y, a.z * x.z};  // well inside
      const Distance to = shape.distance(x);
      // The nearest point is on the surface: an error eps of phi and x moves F by eps
      // over the least axis.
      const Vec y = x - to.value * to.gradient;
      const double f =
          y.x * y.x / (a.x * a.x) + y.y * y.y / (a.y * a.y) + y.z * y.z / (a.z * a.z);
      EXPECT_NEAR(f, 1, 2000 * eps) << i;
      const double inside =
          x.x * x.x / (a.x * a.x) + x.y * x.y / (a.y * a.y) + x.z * x.z / (a.z * a.z);
      EXPECT_EQ(to.value < 0, inside < 1);
      if (inside > 1) {
        EXPECT_LE(shape.at_least(x), to.value + 10 * eps);
      }
      double least = 1e9;
      for (const Vec& p : points) least = std::min(least, norm(p - x));
      EXPECT_GE(least, std::abs(to.value) * (1 - 100 * eps) - 10 * eps) << i;
    }
  }
}

TEST(BodyShapes, ARoundEllipsoidIsASphere) {
  const Ellipsoid round({0.6, 0.6, 0.6});
  const Cloud cloud(50);
  for (std::size_t i = 0; i < 50; ++i) {
    const Vec x = load3(&cloud.x[3 * i]);
    EXPECT_NEAR(round.distance(x).value, sphere.distance(x).value, 8 * eps);
    const Mat3 d = round.curvature(x) - sphere.curvature(x);
    EXPECT_LE(norm(d.r0) + norm(d.r1) + norm(d.r2), 400 * eps / norm(x));
  }
}

TEST(BodyShapes, DistanceOfACapsuleIsThatToItsAxis) {
  EXPECT_DOUBLE_EQ(capsule.distance({0.5, 0, 0.2}).value, 0.1);
  EXPECT_DOUBLE_EQ(capsule.distance({0, 0, 1}).value, 0.1);
  EXPECT_NEAR(capsule.distance({0.3, 0, -0.9}).value, 0.1, 4 * eps);
  EXPECT_EQ(capsule.distance({0, 0, 0.3}).value, -0.4);
}

TEST(BodyShapes, DeepestInsideIsTheLeastHalfAxis) {
  EXPECT_NEAR(ellipsoid.distance({0, 0, 0}).value, -0.5, 4 * eps);
  EXPECT_NEAR(flat.distance({0, 0, 0}).value, -0.1, 4 * eps);
  EXPECT_EQ(sphere.distance({0, 0, 0}).value, -0.6);
}

}  // namespace tress::test_body_shapes
