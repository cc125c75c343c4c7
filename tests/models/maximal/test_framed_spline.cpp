// What the material frame brings to the dynamic spline: curls, twist, flat sections.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/fit.h"
#include "models/splines/spline_strain.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/drift.h"
#include "tests/models/maximal/points_after.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"
#include "tests/support/variable.h"

namespace tress::test_framed_spline {

using namespace experiments;

using namespace testing_support;

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
  using T = testing_support::Dual2<size>;
  T y[size], strain[Part::strains];
  for (int k = 0; k < size; ++k) {
    y[k] = testing_support::variable2<size>(x[k], static_cast<std::size_t>(k));
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
                                  {"natural_curvature_per_m", "40"},
                                  {"natural_curvature2_per_m", "10"},
                                  {"natural_twist_per_m", "20"},
                                  {"ellipticity", "1.3"}};

TEST(FramedSpline, TangentIsExactForCurlsWithFriction) {
  for (const char* root : {"shake_rotate", "free"}) {
    const auto system = make_model(
        "dynamic_spline",
        with(curly_hair, {{"motion", root}, {"internal_friction_kg_m3_s", "1e-7"}}));
    States s(*system);
    for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
      s.shake(0.05);
      EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance) << root;
    }
  }
}

// Forces of rounding: eps EA of each of some ten terms.
TEST(FramedSpline, ACurlAtRestHasNoForce) {
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

// Of 1/sqrt(1.3) and sqrt(1.3) times the stiffness EI1 and EI2 of either plane has; the
// same errors as of the circular section.
TEST(FramedSpline, EllipticSectionsSwingInTwoPlanes) {
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
TEST(FramedSpline, TwistsAtTheFrequenciesOfAShaft) {
  for (const int n : {10, 20, 40}) {
    const ModelSettings settings = {{"elements", std::to_string(n)},
                                    {"ellipticity", "1.3"},
                                    {"natural_twist_per_m", "20"}};
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
        symmetric_eigenvalues(scale.asDiagonal() * k * scale.asDiagonal());
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
TEST(FramedSpline, CurlyHairApproachesKirchhoffsRodAtOrder2) {
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

// Curls on a root that shakes and turns, with friction: the tip goes where discrete
// elastic rods take it. Both are of order 2: from 20 and 40 elements to none between, on
// which one relies as far as it moves either tip.
TEST(FramedSpline, CurlsOnAShakenRootMoveAsDiscreteRodsDo) {
  const auto limit = [](const char* model, double& moved) {
    const auto tip = [model](const char* elements) {
      std::vector<double> q;
      const std::vector<double> x = points_after(model,
                                                 {{"motion", "shake_rotate"},
                                                  {"elements", elements},
                                                  {"radius_m", "1e-3"},
                                                  {"youngs_modulus_pa", "1e7"},
                                                  {"natural_curvature_per_m", "40"},
                                                  {"natural_twist_per_m", "20"},
                                                  {"ellipticity", "1.3"},
                                                  {"internal_friction_kg_m3_s", "1e-8"}},
                                                 0.2, q);
      return load3(&x[x.size() - 3]);
    };
    const Vec fine = tip("40"), by = (1.0 / 3) * (fine - tip("20"));
    moved += norm(by);
    return fine + by;
  };
  double moved = 0;
  const Vec apart = limit("dynamic_spline", moved) - limit("der", moved);
  std::printf("tips apart by %.2e m, extrapolated by %.2e m\n", norm(apart), moved);
  EXPECT_LE(norm(apart), moved);
  EXPECT_LE(moved, 2e-3 * 0.1);  // of the length
}

// Angles turn with theta', not with the section's spin theta' + c . e' (rod_edge.h): the
// momentum drifts and, with a new reference frame, the energy jumps, either by no more
// than twice the sections' share at the start, and the energy by the rule's own error,
// 1e-6.
TEST(FramedSpline, MidpointLosesNoMoreThanTheSpinOfSections) {
  const auto system = make_model("dynamic_spline", bent_throw);
  const Strand rod = strand(parameters_of("dynamic_spline", bent_throw));
  const State start = initial_state(*system);
  Energetics& energetics = *system->energetics();
  const Momentum momentum = energetics.momentum(0, start.q, start.v).value();
  const Vec angular = load3(momentum.angular.data());
  constexpr double spin = 10;  // rad/s
  const double of_sections =
      rod.material.density * rod.segments.front().section.polar() * rod.length() * spin;
  const Drift off = drift(*system, 0.025e-3);
  std::printf("dynamic_spline: energy off by %.2e, momentum by %.2e\n", off.energy,
              off.momentum);
  EXPECT_LE(off.momentum, 2 * of_sections / norm(angular));
  EXPECT_LE(off.energy,
            of_sections * spin / energetics.energy(0, start.q, start.v).kinetic + 1e-6);
}

// That this is all: sections of half the radius, a quarter of the inertia, leave a
// quarter of the drift whatever the step, and until a reference is renewed, at 60 degrees
// or 0.1 s, the energy keeps to the rule's order. Then it has a floor.
TEST(DiscreteRod, DriftsByTheInertiaOfItsAnglesAlone) {
  const auto of = [](double step, double duration, const ModelSettings& section) {
    return drift(*make_model("der", with(bent_throw, section)), step, duration);
  };
  const Drift thick = of(0.05e-3, 0.1, {}), finer = of(0.025e-3, 0.1, {});
  const Drift thin =
      of(0.05e-3, 0.1, {{"radius_m", "0.5e-3"}, {"youngs_modulus_pa", "4e6"}});
  EXPECT_NEAR(finer.momentum / thick.momentum, 1, 0.01);
  EXPECT_NEAR(thick.momentum / thin.momentum, 4, 0.1);
  EXPECT_NEAR(thick.energy / thin.energy, 4, 0.4);  // and the rule's own, below
  std::vector<double> steps, errors;
  for (const double step : {0.1e-3, 0.05e-3, 0.025e-3}) {
    steps.push_back(step);
    errors.push_back(of(step, 0.05, {}).energy);
  }
  EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.1);
  EXPECT_GT(finer.energy, 30 * errors.back());
}

// A straight strand whose sections spin about it and whose nodes stand still.
TEST(FramedStrands, CountTheSpinOfSectionsInTheMomentum) {
  for (const char* model : {"der", "dynamic_spline"}) {
    const ModelSettings settings{{"elements", "6"}, {"motion", "free"}};
    const auto system = make_model(model, settings);
    const Strand rod = strand(parameters_of(model, settings));
    State state = initial_state(*system);
    std::ranges::fill(state.v, 0.0);
    const std::size_t angles = model == std::string("der") ? 6 : 7;
    for (std::size_t k = state.v.size() - angles; k < state.v.size(); ++k)
      state.v[k] = 10;
    const Momentum momentum = system->energetics()->momentum(0, state.q, state.v).value();
    const Vec e0 = rod.free_root->frame.e0;
    const double spin =
        rod.material.density * rod.segments.front().section.polar() * rod.length() * 10;
    // Sums of seven products.
    EXPECT_LE(norm(load3(momentum.angular.data()) - spin * e0), 20 * 2.2e-16 * spin)
        << model;
  }
}

}  // namespace tress::test_framed_spline
