#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "models/strand/geometry.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/shapes.h"

namespace tress::test_shapes {

using namespace simulation;

using std::numbers::pi;

Strand through(const std::vector<double>& points, int elements, PointCurve& curve) {
  curve = through_points(points, elements, 1, {0, 1, 0}, "test");
  return make_strand({}, {}, {elements, curve.length, 1}, curve.shape);
}

/// A half circle by 33 points: the spline's curvature is off by O(h^2), h = pi/32, most
/// at its ends (0.7 % there, a fifth of it over the end elements). Ten elements, 3.2
/// points each.
TEST(Points, OfACircleHaveItsCurvature) {
  constexpr double radius = 0.05;
  std::vector<double> points;
  for (int i = 0; i <= 32; ++i) {
    const double a = pi * i / 32;
    for (const double x : {radius * std::sin(a), 0.0, radius * (1 - std::cos(a))}) {
      points.push_back(x);
    }
  }
  PointCurve curve;
  const Strand strand = through(points, 10, curve);
  EXPECT_NEAR(curve.length, pi * radius, 1e-6 * curve.length);
  for (const Segment& segment : strand.segments) {
    EXPECT_NEAR(norm(segment.natural), 1 / radius, 1.5e-3 / radius);
    EXPECT_NEAR(segment.natural.y, -1 / radius, 1.5e-3 / radius);
  }
}

double tip_error(int elements) {
  std::vector<double> points;
  for (int i = 0; i <= 400; ++i) {
    const double x = i / 400.0;
    for (const double y : {x, 0.1 * std::sin(4 * x), 0.1 * std::cos(3 * x)}) {
      points.push_back(y);
    }
  }
  PointCurve curve;
  const Strand strand = through(points, elements, curve);
  const auto places = joints(strand, ShapeOf::natural, {curve.position, curve.frame});
  return norm(places.back().x - load3(&points[1200]));
}

TEST(Points, AreMetToSecondOrderInTheElements) {
  const double coarse = tip_error(8), middle = tip_error(16), fine = tip_error(32);
  EXPECT_LT(coarse, 0.02);
  EXPECT_GT(std::log2(coarse / middle), 1.7);
  EXPECT_GT(std::log2(middle / fine), 1.7);
}

/// Squares of 400 independent, nearly normal values have a mean within 4 sqrt(2/400) =
/// 0.28 of the variance; so has a product of two, with a smaller deviation.
TEST(Fuzzy, HasTheAmplitudeAndTheCorrelationAskedFor) {
  constexpr double amplitude = 30, correlation = 0.01;
  double square = 0, product = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Shape shape = fuzzy_shape(amplitude, correlation, seed, 0);
    square += shape(0.05).y * shape(0.05).y;
    product += shape(0.05).y * shape(0.05 + correlation).y;
  }
  const double each = 400 * amplitude * amplitude;
  EXPECT_NEAR(square / each, 1, 0.28);
  EXPECT_NEAR(product / each, std::exp(-0.5), 0.28);
}

TEST(Fuzzy, IsTheSameForTheSameSeedAndStreamOnly) {
  const double one = fuzzy_shape(30, 0.01, 7, 3)(0.02).y;
  EXPECT_EQ(fuzzy_shape(30, 0.01, 7, 3)(0.02).y, one);
  EXPECT_NE(fuzzy_shape(30, 0.01, 7, 4)(0.02).y, one);
  EXPECT_NE(fuzzy_shape(30, 0.01, 8, 3)(0.02).y, one);
}

TEST(Materials, TheShearModulusIsThatOfTheLastKeyForIt) {
  const Scene scene = parse_scene(R"(title = "t"
[material]
shear_modulus_pa = 5e8
[[strand]]
[[strand]]
[strand.material]
youngs_modulus_pa = 1e9
[[strand]]
[strand.material]
poisson_ratio = 0.25
[[strand]]
[strand.material]
name = "custom"
radius_m = 4e-5
youngs_modulus_pa = 2e9
shear_modulus_pa = 7e8
density_kg_m3 = 1320
)",
                                  "t.toml");
  const auto shear = [&](std::size_t i) {
    return scene.strands[i].material.shear_modulus;
  };
  EXPECT_EQ(shear(0), 5e8);
  EXPECT_EQ(shear(1), 5e8);
  EXPECT_EQ(shear(2), 3.8e9 / 2.5);
  EXPECT_EQ(shear(3), 7e8);
}

TEST(Materials, ANameBringsItsValuesAndKeysChangeSingleOnes) {
  const Scene scene = parse_scene(R"(title = "t"
[material]
name = "hair.asian"
youngs_modulus_pa = 1e6
[[strand]]
[[strand]]
[strand.material]
density_kg_m3 = 1000
[[strand]]
[strand.material]
name = "hair.asian"
)",
                                  "t.toml");
  ASSERT_EQ(scene.strands.size(), 3u);
  const auto material = [&](std::size_t i) { return scene.strands[i].material; };
  EXPECT_EQ(material(0).youngs_modulus, 1e6);
  EXPECT_EQ(material(0).density, 1320);
  EXPECT_EQ(material(1).youngs_modulus, 1e6);
  EXPECT_EQ(material(1).density, 1000);
  EXPECT_EQ(material(2).youngs_modulus, 3.8e9);
  // Hair is not isotropic: 3.89 and 0.89 GPa. Softer hair has the same ratio.
  EXPECT_DOUBLE_EQ(material(2).shear_modulus, 3.8e9 * 0.89 / 3.89);
  EXPECT_DOUBLE_EQ(material(0).shear_modulus, 1e6 * 0.89 / 3.89);
  const CrossSection& section = scene.strands[0].segments[0].section;
  EXPECT_NEAR(section.a1 / section.a2, 1.29, 1e-14);
  EXPECT_NEAR(section.area(), 5063e-12, 0.0025 * 5063e-12);  // radius to 0.1 um
}

TEST(Roots, AreWhereTheSceneSaysAndMoveWithTheHead) {
  const Scene scene = parse_scene(R"(title = "t"
[strand]
position_m = [0.1, 0, 0.2]
root_tangent = [0, 0, -2]
normal = [1, 0, 5]
[root]
motion = "rotate"
axis = [0, 0, 1]
centre_m = [0, 0, 0.2]
angle_rad = 1.5707963267948966
frequency_hz = 0.25
)",
                                  "t.toml");
  const RootMotion& root = scene.strands.front().root;
  const RootPose start = root.at(0), end = root.at(1);  // a quarter of a turn
  EXPECT_LE(norm(start.x - Vec{0.1, 0, 0.2}), 1e-16);
  EXPECT_LE(norm(start.frame.e0 - Vec{0, 0, -1}), 1e-16);
  EXPECT_LE(norm(start.frame.e1 - Vec{1, 0, 0}), 1e-15);
  EXPECT_LE(norm(end.x - Vec{0, 0.1, 0.2}), 1e-15);
  EXPECT_LE(norm(end.frame.e1 - Vec{0, 1, 0}), 1e-15);
  // head takes what is at rest at x to position + frame x.
  const RootPose head = scene.head.at(1);
  EXPECT_LE(norm(head.x + head.frame * Vec{0.1, 0, 0.2} - end.x), 1e-15);
}

TEST(Roots, OfAHeadAreFreeAfterTheLastPeriod) {
  const Scene scene = parse_scene(R"(title = "t"
[strand]
[root]
motion = "head"
frequency_hz = 2
periods = 3
inertia_kg_m2 = 0.02
damping_n_m_s = 0.1
stiffness_n_m = 2
)",
                                  "t.toml");
  const Signal& angle = scene.head.rotations.front().signal;
  const SignalValue x = angle(1.7);
  EXPECT_NEAR(0.02 * x.acceleration + 0.1 * x.rate + 2 * x.value, 0, 1e-13);
  EXPECT_GT(std::abs(x.value), 1e-4);
}

}  // namespace tress::test_shapes
