#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "experiments/numerics/fit.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/rod_edge.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/thin_rod.h"

namespace tress::test_der {

using namespace experiments;

using namespace testing_support;

TEST(Der, CantileverApproachesTheGravitoBendingCurveAtOrder2) {
  for (const Master& exact : master_curve) {
    std::vector<double> sizes, errors;
    for (const int n : {5, 10, 20, 40, 80, 160, 320}) {
      sizes.push_back(1.0 / n);
      errors.push_back(master_error("der", thin_rod, exact, n, at_rest));
      std::printf("der, Gamma = %g, N = %d: H/W off by %.2e\n", exact.gamma, n,
                  errors.back());
    }
    EXPECT_LE(errors[3], 0.01);
    // Lumping makes the tip hang too low, 2 tan(angle/2) too high: for Gamma = 10 and 100
    // both cancel near N = 10, and only beyond, where next terms are (kappa h)^2 = 2
    // Gamma h^2 of either, 0.03 for the largest load and h here, does one h^2 show.
    const std::vector<double> last_sizes(sizes.end() - 3, sizes.end());
    const std::vector<double> last_errors(errors.end() - 3, errors.end());
    EXPECT_NEAR(log_log_slope(last_sizes, last_errors), 2, 0.1);
  }
}

TEST(Der, CurlyHairApproachesKirchhoffsRodAtOrder2) {
  std::vector<double> sizes, away, energy_off;
  for (const std::size_t n : {12U, 24U, 48U, 84U, 168U}) {
    const CurlyError error = curly_error("der", thin_rod, n, at_rest);
    sizes.push_back(1.0 / static_cast<double>(n));
    away.push_back(error.points);
    energy_off.push_back(error.energy);
    std::printf("der, N = %zu: points off by %.2e L, energy by %.2e\n", n, away.back(),
                energy_off.back());
  }
  EXPECT_LE(away[3], 5e-3);  // N = 84
  // As of the other strands, see tests/models/reduced/test_cantilever.cpp.
  const auto order = [&](const std::vector<double>& errors) {
    return log_log_slope({sizes.begin() + 1, sizes.end()},
                         {errors.begin() + 1, errors.end()});
  };
  EXPECT_NEAR(order(away), 2, 0.1);
  EXPECT_NEAR(order(energy_off), 2, 0.1);
}

TEST(Der, ClampedFrequenciesApproachTheBeamAtOrder2) {
  std::vector<double> sizes, errors;
  for (const int n : {10, 20, 40}) {
    const std::vector<double> frequencies = bending_frequencies(
        "der", with(thin_rod, {{"gravity_m_s2", "0"}, {"elements", std::to_string(n)}}));
    double worst = 0;
    for (std::size_t mode = 0; mode < 3; ++mode) {
      const double off = frequencies[mode] * std::sqrt(line_density) / beam[mode] - 1;
      worst = std::max(worst, std::abs(off));
      std::printf("der, N = %d, mode %zu: off by %.2e\n", n, mode + 1, off);
    }
    sizes.push_back(1.0 / n);
    errors.push_back(worst);
  }
  EXPECT_LE(errors.back(), 0.01);
  // The next term is (beta h)^2/10 of the first for the third mode: 0.06 at N = 10.
  EXPECT_NEAR(log_log_slope(sizes, errors), 2, 0.1);
}

class ReferenceFrames
    : public testing::TestWithParam<std::pair<std::string_view, std::size_t>> {};

/// Rigid turning of a free strand of that many nodes takes every edge far from its
/// reference: frames, spins and energy must not jump when it gets a new one.
TEST_P(ReferenceFrames, NewOnesLeaveTheMotionAsItIs) {
  const auto [model, nodes] = GetParam();
  const auto system = make_model(model, {{"elements", "6"},
                                         {"motion", "free"},
                                         {"natural_curvature_per_m", "40"},
                                         {"natural_twist_per_m", "30"},
                                         {"gravity_m_s2", "0"}});
  State state = initial_state(*system);
  const std::size_t angles = 3 * nodes;
  const Frame turn = rotation({0, 0.6, 0.8}, 1.3);  // 74 degrees
  for (std::size_t i = 0; i < nodes; ++i) {
    store3(turn * load3(&state.q[3 * i]) + Vec{0, 0, 1e-3 * std::sin(i)},
           &state.q[3 * i]);
    store3(Vec{std::cos(i), 1, std::sin(i)}, &state.v[3 * i]);
  }
  for (std::size_t k = angles; k < state.q.size(); ++k) state.q[k] = 0.3;
  Energetics& energetics = *system->energetics();
  const std::vector<double> zero = zeros(*system);
  const double before = energetics.energy(0, state.q, state.v).potential;
  const std::vector<double> force = residual(*system, state.q, zero, zero);
  std::vector<double> work(1);
  for (std::size_t k = 0; k < zero.size(); ++k) work[0] += force[k] * state.v[k];

  EXPECT_TRUE(system->accept(0, state.q, state.v));
  EXPECT_FALSE(system->accept(0, state.q, state.v));
  EXPECT_NEAR(energetics.energy(0, state.q, state.v).potential / before, 1, 1e-12);
  // Forces on nodes change with the meaning of the angles' rates, their work does not.
  const std::vector<double> after = residual(*system, state.q, zero, zero);
  double now = 0;
  for (std::size_t k = 0; k < zero.size(); ++k) now += after[k] * state.v[k];
  EXPECT_NEAR(now / work[0], 1, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Maximal, ReferenceFrames,
                         testing::Values(std::pair("der", 7),
                                         std::pair("dynamic_spline", 9)),
                         [](const auto& test) { return std::string(test.param.first); });

class WholeTurns : public testing::TestWithParam<std::string_view> {};

/// The last section of a straight strand is turned about its axis, step by step, by five
/// quarters of a turn and more: energy is as the square of the angle, the moment as the
/// angle, and both are the same from what the strand remembers.
TEST_P(WholeTurns, GoOnTwistingAJoint) {
  const ModelSettings settings = {{"elements", "4"}, {"gravity_m_s2", "0"}};
  const auto system = make_model(GetParam(), settings);
  State state = initial_state(*system);
  const std::vector<double> zero = zeros(*system);
  const auto energy = [&](System& of, double angle) {
    state.q.back() = angle;
    return of.energetics()->energy(0, state.q, state.v).potential;
  };
  const auto moment = [&](double angle) {
    state.q.back() = angle;
    return residual(*system, state.q, zero, zero).back();
  };
  const double one = energy(*system, 1), moment_of_one = moment(1);
  ASSERT_GT(one, 0);
  double angle = 0;
  while (angle < 8) {
    angle += 0.5;
    EXPECT_NEAR(energy(*system, angle) / (angle * angle * one), 1, 1e-10) << angle;
    EXPECT_NEAR(moment(angle) / (angle * moment_of_one), 1, 1e-10) << angle;
    system->accept(0, state.q, state.v);
  }
  const auto other = make_model(GetParam(), settings);
  other->recall(system->memory());
  EXPECT_EQ(energy(*other, angle), energy(*system, angle));
  // Back where it began: all turns are forgotten, and what is left is the nearest.
  system->reset();
  const double left = angle - 2 * std::numbers::pi;
  EXPECT_NEAR(energy(*system, angle) / (left * left * one), 1, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Maximal, WholeTurns, testing::Values("der", "dynamic_spline"),
                         [](const auto& test) { return std::string(test.param); });

/// Turning an edge around a cone and back leaves no trace while its reference stays;
/// with a new one on the way the frame comes back turned about the edge by the area that
/// the tangent went around on the sphere, 2 pi (1 - cos 35 deg).
TEST(Der, HolonomyIsTheAreaAroundWhichTheTangentWent) {
  using std::numbers::pi;
  const double cone = 70 * pi / 180 / 2;
  const Vec axis{std::cos(cone), 0, std::sin(cone)};
  Frame reference, frame = edge_frame(reference, Vec{1, 0, 0}, 0.0);
  for (const bool renew : {false, true}) {
    reference = frame = Frame{};
    constexpr int steps = 3600;
    for (int i = 1; i <= steps; ++i) {
      const Vec t = rotation(axis, 2 * pi * i / steps) * Vec{1, 0, 0};
      frame = edge_frame(reference, t, 0.0);
      if (renew) reference = frame;
    }
    const double turned = joint_strain(Frame{}, frame).x;
    const double area = 2 * pi * (1 - std::cos(cone));
    std::printf("holonomy %s: %.6f rad, area %.6f\n", renew ? "renewed" : "kept", turned,
                area);
    if (renew) {
      // Steps of angle 2 pi sin(35 deg)/3600 = 1e-3 leave the area off by its square.
      EXPECT_NEAR(std::abs(turned), area, 1e-5);
    } else {
      EXPECT_NEAR(turned, 0, 1e-12);
    }
  }
}

// Friction strong enough to be a large part of every row, at speeds that count.
TEST(Der, TangentIsExactForCurlsWithFriction) {
  for (const char* root : {"shake_rotate", "free"}) {
    for (const char* stretch : {"extensible", "inextensible"}) {
      const auto system = make_model("der", {{"elements", "6"},
                                             {"motion", root},
                                             {"stretch", stretch},
                                             {"natural_curvature_per_m", "40"},
                                             {"natural_curvature2_per_m", "10"},
                                             {"natural_twist_per_m", "20"},
                                             {"ellipticity", "1.3"},
                                             {"internal_friction_kg_m3_s", "1e-7"}});
      States s(*system);
      for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
        s.shake(0.05);
        EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance)
            << root << ' ' << stretch;
      }
    }
  }
}

}  // namespace tress::test_der
