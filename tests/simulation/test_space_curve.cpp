// Curves through points: as curved at their ends as within.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "simulation/groom/space_curve.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"

namespace tress::test_space_curve {

using namespace simulation;
using std::numbers::pi;

/// A curve of constant curvature: its place at arc length s.
struct Curved {
  std::function<Vec(double)> at;
  double curvature, length;
};

Curved circle() {
  return {[](double s) { return Vec{std::sin(s), 0, 1 - std::cos(s)}; }, 1, pi};
}
/// Radius 1, pitch angle atan(0.3).
Curved helix() {
  const double rate = 1 / std::hypot(1, 0.3);
  return {[rate](double s) {
            const double a = rate * s;
            return Vec{std::cos(a), std::sin(a), 0.3 * a};
          },
          rate * rate, 6 / rate};
}

SpaceCurve through(const Curved& curved, int points) {
  std::vector<Vec> x;
  for (int i = 0; i < points; ++i) {
    x.push_back(curved.at(curved.length * i / (points - 1)));
  }
  return {x, 16, "test"};
}

/// Largest difference of the curvature anywhere, and of int k^2 ds, both relative.
struct Errors {
  double curvature = 0, energy = 0;
};

Errors errors(const Curved& curved, int points) {
  const SpaceCurve curve = through(curved, points);
  constexpr int parts = 400;
  Errors error;
  double energy = 0, s = 0;
  Vec tangent = curve.tangent(0);
  for (int i = 1; i <= parts; ++i) {
    const double next = curve.length() * i / parts;
    const Vec then = curve.tangent(curve.parameter(next));
    const double k = norm(then - tangent) / (next - s);
    error.curvature = std::max(error.curvature, std::abs(k / curved.curvature - 1));
    energy += k * k * (next - s);
    s = next;
    tangent = then;
  }
  const double exact = curved.curvature * curved.curvature * curved.length;
  error.energy = std::abs(energy / exact - 1);
  return error;
}

/// The second derivative of a cubic spline is off by O(h^2) if its ends are; what the
/// ends change reaches one piece far, so that the energy is off by O(h^3). With straight
/// ends the largest error is 1 however many points there are, and the energy's O(h).
TEST(SpaceCurve, KeepsItsCurvatureUpToTheEnds) {
  for (const Curved& curved : {circle(), helix()}) {
    const Errors coarse = errors(curved, 33), fine = errors(curved, 65);
    EXPECT_GT(std::log2(coarse.curvature / fine.curvature), 1.7);
    EXPECT_GT(std::log2(coarse.energy / fine.energy), 2.7);
    EXPECT_LT(fine.curvature, 0.01);
    EXPECT_LT(fine.energy, 2e-4);
  }
}

/// Three points give a parabola, whose curvature falls by 3/2 a^2 where it is turned by a
/// from its vertex: 0.15 % of an arc of 0.2 rad, with as much again for its length. Four
/// give one cubic.
TEST(SpaceCurve, OfFewPointsIsOnePolynomial) {
  Curved arc = circle();
  arc.length = 0.2;
  for (const int points : {3, 4}) EXPECT_LT(errors(arc, points).curvature, 0.03);
  const SpaceCurve cubic = through(circle(), 4);
  // Third differences of dx/du vanish.
  const auto rate = [&](int i) { return cubic.rate(cubic.knots().back() * i / 7); };
  for (int i = 0; i + 3 <= 7; ++i) {
    const Vec third = rate(i + 3) - 3.0 * rate(i + 2) + 3.0 * rate(i + 1) - rate(i);
    EXPECT_NEAR(norm(third), 0, 1e-13);
  }
  const std::vector<Vec> two{{0, 0, 0}, {0, 0, 1}};
  EXPECT_NEAR(norm(SpaceCurve(two, 4, "test").position(0.25) - Vec{0, 0, 0.25}), 0,
              1e-15);
}

/// An end piece 80 times as long as the ones before it, by points with noise e = 1e-7 at
/// distances h = 0.02: second derivatives within are about 10 e/h^2, three times that at
/// the end, over L = 1.6: at most 30 e (L/h)^2/16 = 1.2e-3.
TEST(SpaceCurve, IsNearItsPointsWhereTheyAreUneven) {
  std::vector<Vec> points;
  for (int i = 0; i < 5; ++i) points.push_back({i % 2 == 0 ? 1e-7 : -1e-7, 0, 0.02 * i});
  points.push_back({0, 0, 1.7});
  const SpaceCurve curve(points, 4, "test");
  for (int i = 0; i <= 100; ++i) {
    EXPECT_LT(std::abs(curve.position(1.7 * i / 100).x), 1.2e-3);
  }
}

/// A rod bent into an arc and let go, after a public report: a steel cantilever of 1 m,
/// radius 5 mm, through nine points of curvature k = 0.02 1/m.
Scene bent_rod(double duration) {
  std::string points;
  for (int i = 0; i <= 8; ++i) {
    const double x = i / 8.0;
    points += fmt::format("{}[{}, 0, {}]", i > 0 ? ", " : "", x, 0.01 * x * x);
  }
  return parse_scene("title = \"bent rod\"\nduration_s = " + fmt::format("{}", duration) +
                         "\n[model]\nid = \"super_clothoid\"\n[integrator]\n"
                         "id = \"esdirk43\"\ndt_s = 2e-4\n[material]\nname = \"custom\"\n"
                         "radius_m = 5e-3\nellipticity = 1\nyoungs_modulus_pa = 2e11\n"
                         "poisson_ratio = 0.3\ndensity_kg_m3 = 7800\n"
                         "internal_friction_kg_m3_s = 0\n[strand]\nelements = 10\n"
                         "natural = \"straight\"\npoints = [" +
                         points + "]\n",
                     "bent_rod.toml");
}

/// Its elastic energy is E I k^2 L/2 = 1.9635e-2 J, but for the arc being a parabola
/// (k^2 L^2) and for what the cubic elements' curvature loses. Half a period of the first
/// mode after its release, all modes of an Euler-Bernoulli cantilever have its tip at
/// -8.375 mm; ten elements shift the first mode's phase by less than 1e-3.
TEST(PointsOfARod, ReleaseItsEnergy) {
  constexpr double half_period = 0.0705815;
  const Scene scene = bent_rod(half_period);
  World world(scene);
  const double inertia = pi * std::pow(5e-3, 4) / 4;
  const double energy = 2e11 * inertia * 0.02 * 0.02 / 2;
  EXPECT_NEAR(world.energies().elastic / energy, 1, 5e-3);
  ASSERT_EQ(world.advance(half_period), Status::ok) << world.failure();
  const std::vector<double>& x = world.positions();
  EXPECT_NEAR(x[x.size() - 1], -8.375e-3, 0.05e-3);
}

}  // namespace tress::test_space_curve
