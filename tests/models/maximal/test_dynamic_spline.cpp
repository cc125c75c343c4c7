#include <gtest/gtest.h>

#include <cstdio>

#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "models/splines/cubic_spline.h"
#include "models/splines/spline_elasticity.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/drift.h"
#include "tests/models/maximal/points_after.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"
#include "tests/support/variable.h"

namespace tress::test_dynamic_spline {

using namespace experiments;

using namespace testing_support;
using testing_support::variable;

// A cubic is in the space, with its derivatives: exact to rounding of N'' ~ 1/h^2 = 100.
TEST(CubicSpline, HoldsCubicsOnUnevenSpans) {
  const CubicSpline spline({0.1, 0.3, 0.2, 0.4});
  // Through (s, s^2, s^3): e0 is what `through` takes for r' at the ends.
  const auto place = [](double s) {
    return StrandPlace{{s, s * s, s * s * s}, {{1, 2 * s, 3 * s * s}, {}, {}}};
  };
  const std::vector<Vec> controls =
      spline.through({place(0), place(0.1), place(0.4), place(0.6), place(1)});
  double start = 0;
  for (std::size_t i = 0; i < spline.spans(); ++i) {
    for (const double part : {0.0, 0.3, 1.0}) {
      const double along = part * spline.length(i), s = start + along;
      const CubicSpline::Basis basis = spline.at(i, along);
      Vec x, first, second;
      for (std::size_t k = 0; k < 4; ++k) {
        x = x + basis.value[k] * controls[i + k];
        first = first + basis.first[k] * controls[i + k];
        second = second + basis.second[k] * controls[i + k];
      }
      const Vec off[] = {x - Vec{s, s * s, s * s * s}, first - Vec{1, 2 * s, 3 * s * s},
                         second - Vec{0, 2, 6 * s}};
      for (const Vec& d : off) EXPECT_LE(norm(d), 1e-12);
    }
    start += spline.length(i);
  }
}

TEST(DynamicSpline, ForcesAreTheGradientOfTheEnergy) {
  using Point = SplineElasticity::Point;
  constexpr std::size_t spans = 2, size = 3 * (spans + 3);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Point> points;
  for (const std::size_t span : {0U, 0U, 1U}) {
    Point point{span, {}, {}, 2, 3, 0.8};
    for (double& x : point.first) x = uniform(random);
    for (double& x : point.second) x = uniform(random);
    points.push_back(point);
  }
  SplineElasticity elasticity(spans, points);
  std::vector<double> z(size), rate(size), force(size);
  for (double& x : z) x = uniform(random);
  const RootPose root;
  elasticity.add_force({root, z, rate}, force);
  for (std::size_t k = 0; k < size; ++k) {
    using T = Dual<1>;
    std::vector<T> y(z.begin(), z.end());
    y[k] = variable<1>(z[k], 0);
    T energy(0);
    for (const Point& point : points) {
      Vec3<T> a, b;
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3<T> control = load3(&y[3 * (point.span + i)]);
        a = a + T(point.first[i]) * control;
        b = b + T(point.second[i]) * control;
      }
      energy += spline_energy(point.stretch, point.length, point.bend, a, b);
    }
    // |a| may be a tenth: terms of bend |b|^2/|a|^3 = 1e3.
    EXPECT_NEAR(force[k], energy.part[0], 1e-12) << k;
    EXPECT_GT(std::abs(force[k]), 1e-3) << k;
    EXPECT_NEAR(elasticity.energy({root, z, rate}), energy.value, 1e-12);
  }
}

TEST(DynamicSpline, CantileverApproachesTheGravitoBendingCurveAtOrder4) {
  for (const Master& exact : master_curve) {
    std::vector<double> sizes, errors;
    for (int n = 5; n <= 40; n *= 2) {
      sizes.push_back(1.0 / n);
      errors.push_back(master_error("dynamic_spline", thin_rod, exact, n, at_rest));
      std::printf("dynamic_spline, Gamma = %g, N = %d: H/W off by %.2e\n", exact.gamma, n,
                  errors.back());
    }
    EXPECT_LE(errors.back(), 0.01);
    // Twice the order of cubics in the second derivatives, c h^4. Terms of the next
    // orders are not small where a span is as long as the boundary layer, Gamma^-1/2:
    // they only raise the fitted order. At Gamma = 1, N = 40 stretching, 1e-8, has its
    // share.
    const std::size_t from = exact.gamma <= 10 ? 0 : 1;
    const auto three = [from](const std::vector<double>& x) {
      return std::span(x).subspan(from, 3);
    };
    EXPECT_GE(log_log_slope(three(sizes), three(errors)), 4) << exact.gamma;
  }
}

// Cubics with consistent mass: omega is (beta h)^4/1440 too high, and the next order,
// measured against it, (beta h)^2/2 at most. Rounding of K, eps (beta_max/beta)^4 and of
// EA, is 1e-9.
TEST(DynamicSpline, ClampedFrequenciesAreThoseOfTheBeamToOrder4) {
  for (const int n : {10, 20, 40}) {
    const std::vector<double> frequencies = bending_frequencies(
        "dynamic_spline",
        with(thin_rod, {{"gravity_m_s2", "0"}, {"elements", std::to_string(n)}}));
    for (std::size_t mode = 0; mode < 3; ++mode) {
      const double off = frequencies[mode] * std::sqrt(line_density) / beam[mode] - 1;
      const double square = beam[mode] / (n * n);  // (beta h)^2
      const double expected = square * square / 1440;
      std::printf("dynamic_spline, N = %d, mode %zu: off by %.2e\n", n, mode + 1, off);
      EXPECT_NEAR(off, expected, square / 2 * expected + 1e-9);
    }
  }
}

TEST(DynamicSpline, RefusesWhatNeedsAMaterialFrame) {
  for (const auto& [key, value] : ModelSettings{{"natural_curvature_per_m", "10"},
                                                {"natural_curvature2_per_m", "10"},
                                                {"natural_twist_per_m", "10"},
                                                {"ellipticity", "1.2"},
                                                {"internal_friction_kg_m3_s", "1e-10"}}) {
    EXPECT_NO_THROW((void)make_model("dynamic_spline", {{key, value}})) << key;
    EXPECT_THROW((void)make_model("dynamic_spline", {{key, value}, {"twist", "none"}}),
                 InputError)
        << key;
  }
}

TEST(DynamicSpline, MidpointKeepsMomentumAndEnergyToOrder2) {
  // Newton's tolerance is 1e-12.
  expect_midpoint_keeps("dynamic_spline", with(bent_throw, {{"twist", "none"}}),
                        {0.05e-3, 0.025e-3, 0.0125e-3}, 1e-12);
}

// The clamp turns and shakes: the end of the spline is where it is and looks where it
// looks, and the tip goes where that of an independent model goes.
TEST(DynamicSpline, FollowsATurningClamp) {
  const ModelSettings shaken = {{"motion", "shake_rotate"},
                                {"elements", "10"},
                                {"radius_m", "1e-3"},
                                {"youngs_modulus_pa", "1e8"}};
  constexpr double t = 0.2;
  std::vector<double> q, unused;
  const std::vector<double> spline = points_after("dynamic_spline", shaken, t, q);
  const RootPose clamp = root_motion(parameters_of("dynamic_spline", shaken)).at(t);
  const Vec off = load3(spline.data()) - clamp.x;
  const Vec first = load3(&q[3]) - load3(q.data());  // control points: along r'
  const Vec turned = cross(clamp.frame.e0, (1 / norm(first)) * first);
  EXPECT_GT(std::abs(clamp.frame.e0.y), 0.1);
  EXPECT_LE(norm(off), 1e-10);
  EXPECT_LE(norm(turned), 1e-8);
  // Helices are of order 2: from 20 and 40 of them to none between, on which one relies
  // as far as it moves the tip, 1e-4 L.
  const auto tip = [](const std::vector<double>& x) { return load3(&x[x.size() - 3]); };
  const auto helices = [&](const char* elements) {
    return tip(
        points_after("super_helix", with(shaken, {{"elements", elements}}), t, unused));
  };
  const Vec fine = helices("40"), moved = (1.0 / 3) * (fine - helices("20"));
  const Vec apart = tip(spline) - (fine + moved);
  std::printf("tip off by %.2e m, extrapolated by %.2e m\n", norm(apart), norm(moved));
  EXPECT_LE(dot(apart, apart), dot(moved, moved));
  EXPECT_LE(dot(moved, moved), 1e-5 * 1e-5);
}

}  // namespace tress::test_dynamic_spline
