#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "experiments/harness/fit.h"
#include "models/input_error.h"
#include "models/maximal/cubic_spline.h"
#include "models/maximal/spline_elasticity.h"
#include "models/maximal/spline_strain.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/drift.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"
#include "tests/support/variable.h"

namespace tress {
namespace {

using namespace testing_support;
using testing::variable;

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
      for (const Vec& d : off) EXPECT_LE(std::sqrt(dot(d, d)), 1e-12);
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

/// Gradients and second derivatives of a part (strained.h), numbers of order one, against
/// derivative numbers.
template <class Part>
void expect_derivatives(Part part) {
  constexpr int size = Part::coordinates;
  const Frame references[2] = {rotation({0, 0.6, 0.8}, 0.7), rotation({0.8, 0, 0.6}, 1)};
  part.reference = references;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  // Near the references' own directions: far from opposite to them, and from |r'| = 0.
  double x[size], stress[2] = {0.7, -1.3};
  for (double& entry : x) entry = 0.5 * uniform(random);
  for (int side = 0; side < 2; ++side) {
    store3(references[side].e0 + load3(x + 4 * side), x + 4 * side);
  }
  if constexpr (size > 8) x[8] += 1;
  using T = testing::Dual2<size>;
  T y[size], strain[Part::strains];
  for (int k = 0; k < size; ++k) {
    y[k] = testing::variable2<size>(x[k], static_cast<std::size_t>(k));
  }
  part.strain(y, strain);
  double gradient[Part::strains][size], second[size][size] = {};
  part.gradient(x, gradient);
  part.add_second(x, stress, second);
  for (std::size_t k = 0; k < size; ++k) {
    for (int m = 0; m < Part::strains; ++m) {
      EXPECT_NEAR(gradient[m][k], strain[m].part[k].value, 1e-13) << m << k;
      EXPECT_GT(std::abs(gradient[m][k]), 1e-4) << m << k;
    }
    for (std::size_t l = 0; l < size; ++l) {
      double expected = 0;
      for (int m = 0; m < Part::strains; ++m) {
        expected += stress[m] * strain[m].part[k].part[l];
      }
      // Sums of some twenty terms of order ten.
      EXPECT_NEAR(second[k][l], expected, 1e-12) << k << " " << l;
    }
  }
}

TEST(SplineStrains, HaveExactDerivatives) {
  expect_derivatives(SplineTwist{.rest = {0.3}});
  expect_derivatives(SplineBend{.part = 0.2, .rest = {0.3, -0.4}});
}

const ModelSettings curly_hair = {{"elements", "6"},
                                  {"natural_curvature_1_m", "40"},
                                  {"natural_curvature2_1_m", "10"},
                                  {"natural_twist_1_m", "20"},
                                  {"ellipticity", "1.3"}};

TEST(DynamicSpline, TangentIsExactForCurlsWithFriction) {
  for (const char* root : {"shake_rotate", "free"}) {
    const auto system = make_model(
        "dynamic_spline",
        with(curly_hair, {{"root", root}, {"internal_friction_kg_m3_s", "1e-7"}}));
    States s(*system);
    for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
      s.shake(0.05);
      EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance) << root;
    }
  }
}

// Forces of rounding: eps EA of each of some ten terms.
TEST(DynamicSpline, ACurlAtRestHasNoForce) {
  const auto system =
      make_model("dynamic_spline", with(curly_hair, {{"gravity_m_s2", "0"}}));
  const State start = initial_state(*system);
  const std::vector<double> zero = zeros(*system);
  const Strand hair = strand(parameters_of("dynamic_spline", curly_hair));
  const double stretch =
      hair.material.youngs_modulus * hair.segments.front().section.area();
  EXPECT_LE(largest(residual(*system, start.q, zero, zero)), 10 * eps * stretch);
  EXPECT_LE(system->energetics()->energy(0, start.q, zero).potential,
            10 * eps * eps * stretch);
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

// Of 1/sqrt(1.3) and sqrt(1.3) times the stiffness EI1 and EI2 of either plane has; the
// same errors as of the circular section.
TEST(DynamicSpline, EllipticSectionsSwingInTwoPlanes) {
  constexpr int n = 40;
  const ModelSettings flat = with(
      thin_rod,
      {{"gravity_m_s2", "0"}, {"elements", std::to_string(n)}, {"ellipticity", "1.3"}});
  const std::vector<double> frequencies = lowest_frequencies("dynamic_spline", flat, 6);
  std::vector<std::pair<double, double>> expected;  // and (beta h)^2
  for (const double plane : {1 / std::sqrt(1.3), std::sqrt(1.3)}) {
    for (const double mode : beam) {
      expected.emplace_back(plane * mode / std::sqrt(line_density), mode / (n * n));
    }
  }
  std::ranges::sort(expected);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [frequency, square] = expected[k];
    const double off = frequencies[k] / frequency - 1, order4 = square * square / 1440;
    std::printf("dynamic_spline, elliptic, mode %zu: off by %.2e\n", k + 1, off);
    EXPECT_NEAR(off, order4, square / 2 * order4 + 1e-9);
  }
}

// Linear elements with lumped inertia: 2/h sin(beta h/2) instead of beta. The angles of a
// straight strand are on their own, the last of q.
TEST(DynamicSpline, TwistsAtTheFrequenciesOfAShaft) {
  for (const int n : {10, 20, 40}) {
    const ModelSettings settings = {{"elements", std::to_string(n)},
                                    {"ellipticity", "1.3"},
                                    {"natural_twist_1_m", "20"}};
    const auto system = make_model("dynamic_spline", settings);
    const Strand shaft = strand(parameters_of("dynamic_spline", settings));
    const CrossSection& section = shaft.segments.front().section;
    const double speed = std::sqrt(shaft.material.shear_modulus * section.torsion() /
                                   (shaft.material.density * section.polar()));
    const State start = initial_state(*system);
    const Eigen::MatrixXd k =
        dense_tangent(*system, start.q, {0, 0, 1}).bottomRightCorner(n, n);
    const Eigen::MatrixXd m =
        dense_tangent(*system, start.q, {1, 0, 0}).bottomRightCorner(n, n);
    const Eigen::VectorXd scale = m.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd squares =
        eigenvalues(scale.asDiagonal() * k * scale.asDiagonal());
    for (int mode = 1; mode <= 3; ++mode) {
      const double exact = (2 * mode - 1) * std::numbers::pi / 2 * speed / shaft.length();
      const double off = std::sqrt(squares[mode - 1]) / exact - 1;
      const double half = exact / speed * shaft.length() / n / 2;  // beta h/2
      std::printf("dynamic_spline, N = %d, twist mode %d: off by %.2e\n", n, mode, off);
      EXPECT_NEAR(off, std::sin(half) / half - 1, 1e-10);
    }
  }
}

// The load grows by smaller steps than elsewhere: from one to thrice its size Newton's
// method goes astray at N = 24.
TEST(DynamicSpline, CurlyHairApproachesKirchhoffsRodAtOrder2) {
  std::vector<double> sizes, away, energy_off;
  for (const std::size_t n : {12U, 24U, 48U, 84U, 168U}) {
    const CurlyError error = curly_error("dynamic_spline", thin_rod, n, at_rest, 1.5);
    sizes.push_back(1.0 / static_cast<double>(n));
    away.push_back(error.points);
    energy_off.push_back(error.energy);
    std::printf("dynamic_spline, N = %zu: points off by %.2e L, energy by %.2e\n", n,
                away.back(), energy_off.back());
  }
  EXPECT_LE(away[3], 5e-3);  // N = 84
  const auto order = [&](const std::vector<double>& errors) {
    return log_log_slope({sizes.begin() + 1, sizes.end()},
                         {errors.begin() + 1, errors.end()});
  };
  EXPECT_NEAR(order(away), 2, 0.1);
  EXPECT_NEAR(order(energy_off), 2, 0.1);
}

TEST(DynamicSpline, RefusesWhatNeedsAMaterialFrame) {
  for (const auto& [key, value] : ModelSettings{{"natural_curvature_1_m", "10"},
                                                {"natural_curvature2_1_m", "10"},
                                                {"natural_twist_1_m", "10"},
                                                {"ellipticity", "1.2"},
                                                {"internal_friction_kg_m3_s", "1e-10"}}) {
    EXPECT_NO_THROW((void)make_model("dynamic_spline", {{key, value}})) << key;
    EXPECT_THROW((void)make_model("dynamic_spline", {{key, value}, {"twist", "none"}}),
                 InputError)
        << key;
  }
}

// A bent strand of six spans thrown into space with a spin of 10 rad/s.
const ModelSettings thrown = {{"elements", "6"},
                              {"root", "free"},
                              {"gravity_m_s2", "0"},
                              {"youngs_modulus_pa", "1e6"},
                              {"radius_m", "1e-3"},
                              {"initial", "bent"},
                              {"initial_curvature_1_m", "20"}};

TEST(DynamicSpline, MidpointKeepsMomentumAndEnergyToOrder2) {
  // Newton's tolerance is 1e-12.
  expect_midpoint_keeps("dynamic_spline", with(thrown, {{"twist", "none"}}),
                        {0.05e-3, 0.025e-3, 0.0125e-3}, 1e-12);
}

// The angles' spin is not in the momentum, and with a new reference frame it changes its
// share of the energy: either is off by no more than twice what it was at the start, and
// the energy by the rule's own error, 1e-6.
TEST(DynamicSpline, MidpointLosesNoMoreThanTheSpinOfSections) {
  const auto system = make_model("dynamic_spline", thrown);
  const Strand rod = strand(parameters_of("dynamic_spline", thrown));
  const State start = initial_state(*system);
  Momentum momentum;
  Energetics& energetics = *system->energetics();
  ASSERT_TRUE(energetics.momentum(0, start.q, start.v, momentum));
  const Vec angular = load3(momentum.angular.data());
  constexpr double spin = 10;  // rad/s
  const double of_sections =
      rod.material.density * rod.segments.front().section.polar() * rod.length() * spin;
  const Drift off = drift(*system, 0.025e-3);
  std::printf("dynamic_spline: energy off by %.2e, momentum by %.2e\n", off.energy,
              off.momentum);
  EXPECT_LE(off.momentum, 2 * of_sections / std::sqrt(dot(angular, angular)));
  EXPECT_LE(off.energy,
            of_sections * spin / energetics.energy(0, start.q, start.v).kinetic + 1e-6);
}

/// Where a strand's points are at t, by the trapezoidal rule.
std::vector<double> points_after(std::string_view model, const ModelSettings& settings,
                                 double t, std::vector<double>& q) {
  const auto system = make_model(model, settings);
  State start{zeros(*system), zeros(*system)};
  system->initial_state(start.q, start.v);
  Options options;
  options.step = 1e-3;
  if (system->layout().constraints > 0) options.formulation = Formulation::projection;
  const Simulation run =
      simulate("generalized_alpha", *system, options, start, t, [&](double, In now, In) {
        q.assign(now.begin(), now.end());
        return true;
      });
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  MaterialPoints& at = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(at.count()));
  at.positions(t, q, x);
  return x;
}

// The clamp turns and shakes: the end of the spline is where it is and looks where it
// looks, and the tip goes where that of an independent model goes.
TEST(DynamicSpline, FollowsATurningClamp) {
  const ModelSettings shaken = {{"root", "shake_rotate"},
                                {"elements", "10"},
                                {"radius_m", "1e-3"},
                                {"youngs_modulus_pa", "1e8"}};
  constexpr double t = 0.2;
  std::vector<double> q, unused;
  const std::vector<double> spline = points_after("dynamic_spline", shaken, t, q);
  const RootPose clamp = root_motion(parameters_of("dynamic_spline", shaken)).at(t);
  const Vec off = load3(spline.data()) - clamp.x;
  const Vec first = load3(&q[3]) - load3(q.data());  // control points: along r'
  const Vec turned = cross(clamp.frame.e0, (1 / std::sqrt(dot(first, first))) * first);
  EXPECT_GT(std::abs(clamp.frame.e0.y), 0.1);
  EXPECT_LE(std::sqrt(dot(off, off)), 1e-10);
  EXPECT_LE(std::sqrt(dot(turned, turned)), 1e-8);
  // Helices are of order 2: from 20 and 40 of them to none between, on which one relies
  // as far as it moves the tip, 1e-4 L.
  const auto tip = [](const std::vector<double>& x) { return load3(&x[x.size() - 3]); };
  const auto helices = [&](const char* elements) {
    return tip(
        points_after("super_helix", with(shaken, {{"elements", elements}}), t, unused));
  };
  const Vec fine = helices("40"), moved = (1.0 / 3) * (fine - helices("20"));
  const Vec apart = tip(spline) - (fine + moved);
  std::printf("tip off by %.2e m, extrapolated by %.2e m\n", std::sqrt(dot(apart, apart)),
              std::sqrt(dot(moved, moved)));
  EXPECT_LE(dot(apart, apart), dot(moved, moved));
  EXPECT_LE(dot(moved, moved), 1e-5 * 1e-5);
}

}  // namespace
}  // namespace tress
