#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "experiments/harness/fit.h"
#include "models/maximal/corde_elasticity.h"
#include "models/maximal/groups.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/drift.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"
#include "tests/support/variable.h"

namespace tress {
namespace {

using namespace testing_support;
using testing::variable;

// Half turns about the axes have one entry of q each.
TEST(Quaternion, HasTheAxesOfItsFrame) {
  for (const Vec& axis :
       {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}, Vec{0.48, 0.6, 0.64}}) {
    for (const double angle : {0.0, 0.3, -2.0, 3.14159, std::numbers::pi}) {
      const Frame frame = rotation(axis, angle);
      const Quaternion q = quaternion_of(frame);
      EXPECT_NEAR(dot(q, q), 1, 1e-15);
      // q v conj(q) for the second axis.
      const Quaternion e1 = q * (Quaternion{0, {0, 1, 0}} * Quaternion{q.w, -1.0 * q.v});
      const Vec off[] = {first_axis(q) - frame.e0, e1.v - frame.e1};
      for (const Vec& d : off) EXPECT_LE(std::sqrt(dot(d, d)), 4e-16 * 4);
      const Vec turn = turn_between(quaternion_of({}), nearer({}, q));
      EXPECT_NEAR(std::sqrt(dot(turn, turn)), 2 * std::sin(std::abs(angle) / 2),
                  1e-15 * 4);
    }
  }
}

// A strand of three edges with numbers of order one, far from rest.
TEST(Corde, ForcesAreTheGradientOfTheEnergy) {
  constexpr std::size_t edges = 3, size = 3 * (edges + 1) + 4 * edges;
  const CordeEdge edge{1, 2, 0, 0.7, 0.9};
  const RodJoint joint{{0.3, -0.4, 0.2}, {1, 2, 3}, {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const bool walled : {false, true}) {
    CordeElasticity elasticity(std::vector(edges, edge),
                               std::vector(walled ? edges : edges - 1, joint), walled);
    RootPose root;
    root.frame = rotation({0, 0.6, 0.8}, 0.7);
    std::vector<double> z(size), rate(size), force(size);
    for (double& x : z) x = uniform(random);
    elasticity.add_force({root, z, rate}, force);
    const Quaternion q0 = load_quaternion(&z[3 * (edges + 1)]);
    const Quaternion wall = nearer(q0, quaternion_of(root.frame));
    for (std::size_t k = 0; k < size; ++k) {
      using T = Dual<1>;
      std::vector<T> y(z.begin(), z.end());
      y[k] = variable<1>(z[k], 0);
      T energy(0);
      QuaternionOf<T> before{T(wall.w), Vec3<T>(wall.v)};
      for (std::size_t i = 0; i < edges; ++i) {
        const auto q = load_quaternion(&y[3 * (edges + 1) + 4 * i]);
        energy += edge_energy(edge, load3(&y[3 * i + 3]) - load3(&y[3 * i]), q);
        if (i > 0 || walled) energy += joint_energy(joint, before, q);
        before = q;
      }
      // Sums of some ten terms of order ten.
      EXPECT_NEAR(force[k], energy.part[0], 1e-13) << k;
      EXPECT_GT(std::abs(force[k]), 1e-3) << k;
      EXPECT_NEAR(elasticity.energy({root, z, rate}), energy.value, 1e-13);
    }
  }
}

TEST(Corde, TangentIsExactWithAllFrictionOnATurningRoot) {
  const auto system = make_model("corde", {{"elements", "6"},
                                           {"root", "shake_rotate"},
                                           {"internal_friction_kg_m3_s", "1e-7"},
                                           {"stretch_friction_n_s", "1e-3"},
                                           {"natural_curvature_1_m", "40"},
                                           {"natural_twist_1_m", "20"},
                                           {"ellipticity", "1.3"}});
  States s(*system);
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
    s.shake(0.05);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance);
  }
}

TEST(Corde, CantileverApproachesTheGravitoBendingCurveAtOrder2) {
  for (const Master& exact : master_curve) {
    std::vector<double> sizes, errors;
    const int finest = exact.gamma <= 10 ? 80 : 160;
    for (int n = 5; n <= finest; n *= 2) {
      sizes.push_back(1.0 / n);
      errors.push_back(master_error("corde", thin_rod, exact, n, at_rest));
      std::printf("corde, Gamma = %g, N = %d: H/W off by %.2e\n", exact.gamma, n,
                  errors.back());
    }
    EXPECT_LE(errors[3], 0.01);
    // Beside the trapezoidal sums of the other strands a joint's moment is sin(u h) EI/h,
    // u^2 < 2 Gamma: the next order is (u h)^2 of the leading one, here allowed twice, at
    // the coarsest of three sizes over a factor of 4. Stretching, Gamma/4e6, is up to 1 %
    // of the error at the finest.
    const std::size_t from = sizes.size() - 3;
    const auto last = [from](const std::vector<double>& x) {
      return std::vector<double>(x.begin() + static_cast<std::ptrdiff_t>(from), x.end());
    };
    const double next = 2 * 2 * exact.gamma * sizes[from] * sizes[from];
    EXPECT_NEAR(log_log_slope(last(sizes), last(errors)), 2,
                (next + 0.01) / std::log(4.0))
        << exact.gamma;
  }
}

// Of a light cantilever edges lag behind frames by V/kappa = Gamma (1 - s) h^2/coupling:
// the tip hangs Gamma h^2/(2 coupling) lower, of Gamma/8.
TEST(Corde, CouplingLowersTheTipByItsShear) {
  const Master light{0.1, 0.99991072, 0.01249843798};
  const auto height = [&](const char* coupling, int n) {
    const Hung hung =
        hang("corde",
             with(thin_rod, {{"coupling", coupling}, {"elements", std::to_string(n)}}),
             light.gamma / line_density, at_rest);
    return -points(hung).back();
  };
  for (const int n : {5, 10, 20}) {
    const double h = 1.0 / n;
    const double lowered = height("100", n) - height("10000", n);
    // 1e-3 for the weight's own nonlinearity, (Gamma/8)^2 times some number of order one.
    EXPECT_NEAR(lowered / (light.gamma / 8) / (4 * h * h * (0.01 - 0.0001)), 1, 1e-3);
  }
}

TEST(Corde, CurlyHairApproachesKirchhoffsRodAtOrder2) {
  std::vector<double> sizes, away, energy_off;
  for (const std::size_t n : {12U, 24U, 48U, 96U}) {
    const CurlyError error = curly_error("corde", thin_rod, n, at_rest);
    sizes.push_back(1.0 / static_cast<double>(n));
    away.push_back(error.points);
    energy_off.push_back(error.energy);
    std::printf("corde, N = %zu: points off by %.2e L, energy by %.2e\n", n, away.back(),
                energy_off.back());
  }
  const auto order = [&](const std::vector<double>& errors) {
    return log_log_slope({sizes.begin() + 1, sizes.end()},
                         {errors.begin() + 1, errors.end()});
  };
  // As of the other strands, see tests/models/reduced/test_cantilever.cpp.
  EXPECT_NEAR(order(away), 2, 0.1);
  EXPECT_NEAR(order(energy_off), 2, 0.1);
}

TEST(Corde, ClampedFrequenciesApproachTheBeamAtOrder2) {
  std::vector<double> sizes, errors[3];
  for (const int n : {10, 20, 40}) {
    sizes.push_back(1.0 / n);
    const std::vector<double> frequencies = bending_frequencies(
        "corde",
        with(thin_rod, {{"gravity_m_s2", "0"}, {"elements", std::to_string(n)}}));
    for (std::size_t mode = 0; mode < 3; ++mode) {
      const double off = frequencies[mode] * std::sqrt(line_density) / beam[mode] - 1;
      errors[mode].push_back(std::abs(off));
      std::printf("corde, N = %d, mode %zu: off by %.2e\n", n, mode + 1, off);
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
TEST(Corde, MidpointKeepsMomentumAndEnergyToOrder2) {
  const ModelSettings thrown = {
      {"elements", "10"},          {"root", "free"},
      {"gravity_m_s2", "0"},       {"youngs_modulus_pa", "1e6"},
      {"radius_m", "1e-3"},        {"natural_curvature_1_m", "20"},
      {"natural_twist_1_m", "10"}, {"initial", "straight"}};
  // Newton's tolerance is 1e-12.
  expect_midpoint_keeps("corde", thrown, {0.1e-3, 0.05e-3, 0.025e-3, 0.0125e-3}, 1e-12);
}

}  // namespace
}  // namespace tress
