#include <gtest/gtest.h>

#include <cstdio>

#include "experiments/numerics/fit.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/drift.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"
#include "tests/support/apart.h"

// What holds of every rod of models/quaternion_rods/quaternion_rod.h.
namespace tress::test_quaternion_rods {

using namespace experiments;

using namespace testing_support;

struct Rod {
  const char* model;
  double shear;  // what it lowers a light cantilever by, over its deflection
};

void PrintTo(const Rod& rod, std::ostream* out) { *out << rod.model; }  // NOLINT

class QuaternionRods : public testing::TestWithParam<Rod> {};

// Stretch of edges that a step of Newton's has turned, EA angle^2/2, must not outweigh
// their stiffness against shear, 0.3 EA: smaller steps of the load than elsewhere.
constexpr double growth = 1.1;

TEST_P(QuaternionRods, TangentIsExactWithFrictionOnATurningRoot) {
  const auto system = make_model(GetParam().model, {{"elements", "6"},
                                                    {"motion", "shake_rotate"},
                                                    {"internal_friction_kg_m3_s", "1e-7"},
                                                    {"natural_curvature_per_m", "40"},
                                                    {"natural_twist_per_m", "20"},
                                                    {"ellipticity", "1.3"}});
  States s(*system);
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
    s.shake(0.05);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance);
  }
}

// By elimination along the strand, and assembled. Stiffness of stretch is some 1e6 of a
// node's inertia at the longer step, which times a rounding of 1e-16 and of some hundred
// sums leaves 1e-8 of the solution.
TEST_P(QuaternionRods, SolveTheAssembledEquations) {
  const auto made = [](const char* solver) {
    return make_model(GetParam().model, {{"elements", "12"},
                                         {"motion", "shake_rotate"},
                                         {"internal_friction_kg_m3_s", "1e-7"},
                                         {"natural_curvature_per_m", "40"},
                                         {"solver", solver}});
  };
  const auto system = made("auto"), assembled = made("klu");
  States s(*system);
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
    s.shake(0.05);
    std::vector<double> r(s.q.size()), x(r.size()), want(r.size());
    ASSERT_EQ(system->residual(0.1, s.q, s.v, s.a, r), Status::ok);
    for (const auto& [by, to] : {std::pair{system.get(), &x}, {assembled.get(), &want}}) {
      ASSERT_EQ(by->linearize(0.1, s.q, s.v, s.a, w), Status::ok);
      ASSERT_EQ(by->solve(r, *to), Status::ok);
    }
    EXPECT_NE(x, want);  // or both are assembled
    EXPECT_LE(apart(x, want), 1e-8 * apart(want, std::vector<double>(want.size())));
  }
}

TEST_P(QuaternionRods, CantileverApproachesTheGravitoBendingCurveAtOrder2) {
  for (const Master& exact : master_curve) {
    std::vector<double> sizes, errors;
    const int finest = exact.gamma <= 10 ? 80 : 160;
    for (int n = 5; n <= finest; n *= 2) {
      sizes.push_back(1.0 / n);
      errors.push_back(
          master_error(GetParam().model, thin_rod, exact, n, at_rest, growth));
      std::printf("%s, Gamma = %g, N = %d: H/W off by %.2e\n", GetParam().model,
                  exact.gamma, n, errors.back());
    }
    EXPECT_LE(errors[3], 0.01);
    // Beside the trapezoidal sums of the other strands a joint's moment is sin(u h) EI/h,
    // u^2 < 2 Gamma: the next order is (u h)^2 of the leading one, here allowed twice, at
    // the coarsest of three sizes over a factor of 4. Stretching, Gamma/4e6, is up to 1 %
    // of the error at the finest; shear does not go with h either.
    const std::size_t from = sizes.size() - 3;
    const auto last = [from](const std::vector<double>& x) {
      return std::vector<double>(x.begin() + static_cast<std::ptrdiff_t>(from), x.end());
    };
    const double next = 2 * 2 * exact.gamma * sizes[from] * sizes[from];
    EXPECT_NEAR(log_log_slope(last(sizes), last(errors)), 2,
                (next + 0.01 + GetParam().shear / errors.back()) / std::log(4.0))
        << exact.gamma;
  }
}

TEST_P(QuaternionRods, CurlyHairApproachesKirchhoffsRodAtOrder2) {
  std::vector<double> sizes, away, energy_off;
  for (const std::size_t n : {12U, 24U, 48U, 96U}) {
    const CurlyError error = curly_error(GetParam().model, thin_rod, n, at_rest, growth);
    sizes.push_back(1.0 / static_cast<double>(n));
    away.push_back(error.points);
    energy_off.push_back(error.energy);
    std::printf("%s, N = %zu: points off by %.2e L, energy by %.2e\n", GetParam().model,
                n, away.back(), energy_off.back());
  }
  const auto order = [&](const std::vector<double>& errors) {
    return log_log_slope({sizes.begin() + 1, sizes.end()},
                         {errors.begin() + 1, errors.end()});
  };
  // As of the other strands, see tests/models/reduced/test_cantilever.cpp.
  EXPECT_NEAR(order(away), 2, 0.1);
  EXPECT_NEAR(order(energy_off), 2, 0.1);
}

TEST_P(QuaternionRods, ClampedFrequenciesApproachTheBeamAtOrder2) {
  std::vector<double> sizes, errors[3];
  for (const int n : {10, 20, 40}) {
    sizes.push_back(1.0 / n);
    const std::vector<double> frequencies = bending_frequencies(
        GetParam().model,
        with(thin_rod, {{"gravity_m_s2", "0"}, {"elements", std::to_string(n)}}));
    for (std::size_t mode = 0; mode < 3; ++mode) {
      const double off = frequencies[mode] * std::sqrt(line_density) / beam[mode] - 1;
      errors[mode].push_back(std::abs(off));
      std::printf("%s, N = %d, mode %zu: off by %.2e\n", GetParam().model, n, mode + 1,
                  off);
    }
  }
  for (const auto& of_mode : errors) {
    EXPECT_LE(of_mode.back(), 0.01);
    EXPECT_NEAR(log_log_slope(sizes, of_mode), 2, 0.1);
  }
}

// A soft curl released straight, thrown into space with a spin of 10 rad/s. The rule
// keeps the momenta, bilinear in q and v, as they are. Steps resolve the twist waves, up
// to 2 sqrt(G/rho)/l = 3.4e3 rad/s: h omega <= 0.34, so that the next order is 1 % or so.
TEST_P(QuaternionRods, MidpointKeepsMomentumAndEnergyToOrder2) {
  const ModelSettings thrown = {{"elements", "10"},
                                {"motion", "free"},
                                {"gravity_m_s2", "0"},
                                {"youngs_modulus_pa", "1e6"},
                                {"radius_m", "1e-3"},
                                {"natural_curvature_per_m", "20"},
                                {"natural_twist_per_m", "10"},
                                {"initial", "straight"}};
  // Newton's tolerance is 1e-12.
  expect_midpoint_keeps(GetParam().model, thrown, {0.1e-3, 0.05e-3, 0.025e-3, 0.0125e-3},
                        1e-12);
}

INSTANTIATE_TEST_SUITE_P(Maximal, QuaternionRods,
                         testing::Values(Rod{"corde", 0},
                                         Rod{"xpbd_cosserat", 4 / (0.9 * 4e6 / 2.8)}),
                         [](const auto& test) { return std::string(test.param.model); });

}  // namespace tress::test_quaternion_rods
