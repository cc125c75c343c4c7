#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "models/maximal/angle_strain.h"
#include "tests/support/variable.h"

namespace tress::test_spring_strain {

using namespace models;

using testing_support::Dual2;
using testing_support::variable2;

template <class Strain>
class SpringStrain : public ::testing::Test {};

/// One of each kind, with numbers of order one.
template <class Strain>
Strain example() {
  return {};
}
template <>
Altitude example() {
  return {0.3};
}
template <>
WallAltitude example() {
  return {0.3, 0, {0.2, -0.7, 0.5}};
}
template <>
WallBend example() {
  WallBend strain;
  strain.place(rotation({0, 0.6, 0.8}, 0.7));
  return strain;
}

template <>
Dihedral example() {
  return {0.4, 3e-3, 2e-3};
}
template <>
WallDihedral example() {
  return {{-0.3, 0.1, 2e-3}, 0, {0.9, -0.3, 0.1}};
}

using Strains = ::testing::Types<Chord<1>, Chord<2>, Hinge, Altitude, WallAltitude,
                                 WallBend, BendAngle, Dihedral, WallDihedral>;
TYPED_TEST_SUITE(SpringStrain, Strains);

/// Edges of a bent strand; `bent` = 0: straight.
template <int n>
void edges_of(double bent, std::mt19937& random, Vec (&e)[n]) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Vec& edge : e) {
    const double length = 1 + 0.5 * uniform(random);
    edge = length * Vec{0.6 + bent * uniform(random), bent * uniform(random),
                        0.8 + bent * uniform(random)};
  }
}

TYPED_TEST(SpringStrain, HasTheDerivativesOfItsValue) {
  constexpr int n = 3 * TypeParam::edges;
  const auto strain = example<TypeParam>();
  std::mt19937 random(5);
  for (const double bent : {0.7, 0.3, 1e-2}) {
    Vec e[TypeParam::edges], slope[TypeParam::edges];
    edges_of(bent, random, e);
    Vec3<Dual2<n>> y[TypeParam::edges];
    for (std::size_t k = 0; k < TypeParam::edges; ++k) {
      y[k] = {variable2<n>(e[k].x, 3 * k), variable2<n>(e[k].y, 3 * k + 1),
              variable2<n>(e[k].z, 3 * k + 2)};
    }
    const Dual2<n> exact = strain.value(y);
    double steepest = 0;
    for (const auto& part : exact.part) {
      for (const double x : part.part) steepest = std::max(steepest, std::abs(x));
    }
    // Rounding of sums of ten terms of order one; a hinge divides by its bend, for second
    // derivatives twice. Those that are larger round as their size.
    const double rounding = 1e-14 / bent;
    const double second = 1e-14 * std::max(1 / (bent * bent), steepest);
    EXPECT_NEAR(strain.gradient(e, slope), exact.value.value, rounding);
    EdgeMatrix<TypeParam::edges> h;
    strain.hessian(e, h);
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double g[3] = {slope[i / 3].x, slope[i / 3].y, slope[i / 3].z};
      EXPECT_NEAR(g[i % 3], exact.part[i].value, rounding) << bent << " " << i;
      for (std::size_t j = 0; j < n; ++j) {
        EXPECT_NEAR(h.m[i][j], exact.part[i].part[j], second) << bent << " " << i << j;
        largest = std::max(largest, std::abs(h.m[i][j]));
      }
    }
    EXPECT_GT(largest, 0.1);
  }
}

TEST(Hinge, MeasuresTheAngleAndHasNoKinkWhereItIsStraight) {
  for (const double angle : {0.1, 1.0, 2.0}) {
    const Vec e[2] = {{2, 0, 0}, {std::cos(angle), std::sin(angle), 0}};
    const double exact = 2 * std::tan(angle / 2);
    // delta^2/2 over the strain.
    EXPECT_NEAR(Hinge{}.value(e), exact, 0.51e-8 / exact);
  }
  const Vec straight[2] = {{0.6, 0, 0.8}, {0.3, 0, 0.4}};
  Vec slope[2];
  EXPECT_NEAR(Hinge{}.gradient(straight, slope), Hinge::delta, 1e-18);
  for (const Vec& g : slope) EXPECT_NEAR(dot(g, g), 0, 1e-20);
}

// The length of kb: J^T J by derivative numbers of kb itself.
TEST(Hinge, MetricIsThatOfTheCurvatureBinormal) {
  std::mt19937 random(6);
  for (const double bent : {0.7, 0.3, 0.0}) {
    Vec e[2];
    edges_of(bent, random, e);
    Vec3<Dual<6>> y[2];
    for (std::size_t k = 0; k < 2; ++k) {
      y[k] = {testing_support::variable<6>(e[k].x, 3 * k),
              testing_support::variable<6>(e[k].y, 3 * k + 1),
              testing_support::variable<6>(e[k].z, 3 * k + 2)};
    }
    const Dual<6> c = sqrt(dot(y[0], y[0]) * dot(y[1], y[1])) + dot(y[0], y[1]);
    const Vec3<Dual<6>> kb = (Dual<6>(2.0) / c) * cross(y[0], y[1]);
    EdgeMatrix<2> metric;
    Hinge{}.metric(e, metric);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        const double exact = kb.x.part[i] * kb.x.part[j] + kb.y.part[i] * kb.y.part[j] +
                             kb.z.part[i] * kb.z.part[j];
        EXPECT_NEAR(metric.m[i][j], exact, 1e-14) << bent << " " << i << j;
      }
    }
  }
}

// The shortest way between the lines through the diagonals of a tetrahedron.
TEST(Altitude, IsTheDistanceOfTheDiagonals) {
  // Nodes (0 0 0), (0 1 2), (1 1 0), (1 0 2): the diagonals 0-2 and 1-3 cross at right
  // angles in the planes z = 0 and z = 2.
  const Vec e[3] = {{0, 1, 2}, {1, 0, -2}, {0, -1, 2}};
  EXPECT_NEAR(std::abs(Altitude{1e-20}.value(e)), 2, 1e-14);
}

// The third edge turned about the second, out of the plane of the first two.
TEST(Dihedral, IsTheAngleAboutTheMiddleEdgeFromItsRest) {
  for (const double turned : {-3.0, -1.0, 0.0, 0.5, 2.5}) {
    const double rest = 0.3;
    const Vec e[3] = {
        {1, 0.5, 0}, {2, 0, 0}, {1, -0.5 * std::cos(turned), -0.5 * std::sin(turned)}};
    EXPECT_NEAR((Dihedral{rest, 0, 0}.value(e)),
                std::remainder(turned - rest, 2 * std::numbers::pi), 1e-14);
  }
}

// Two edges in line: the angle is not defined, its part in the energy and forces is none.
TEST(Dihedral, FadesWhereEdgesAreParallel) {
  const Dihedral strain{0.4, 1e-8, 1e-8};
  const Vec e[3] = {{1, 0, 0}, {2, 0, 0}, {1, 0.5, 0.3}};
  Vec g[3];
  EdgeMatrix<3> h;
  EXPECT_EQ(strain.gradient(e, g), 0);
  strain.hessian(e, h);
  for (const Vec& slope : g) EXPECT_EQ(norm(slope), 0);
  for (const auto& row : h.m) {
    for (const double x : row) EXPECT_TRUE(std::isfinite(x));
  }
}

}  // namespace tress::test_spring_strain
