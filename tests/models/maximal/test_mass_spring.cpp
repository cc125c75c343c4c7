#include <gtest/gtest.h>

#include <cstdio>

#include "contract/forms/explicit_form.h"
#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/fit.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/drift.h"
#include "tests/models/maximal/thin_rod.h"

namespace tress::test_mass_spring {

using namespace experiments;

using namespace testing_support;

const ModelSettings curls = {{"elements", "8"},
                             {"natural_curvature_per_m", "40"},
                             {"natural_twist_per_m", "20"},
                             {"torsion", "altitude"}};

class CurledSprings : public testing::TestWithParam<StrandCase> {};

TEST_P(CurledSprings, ForcesAreTheGradientOfTheEnergy) {
  const auto system = GetParam().make({{"gravity_m_s2", "0"}});
  States s(*system);
  const std::vector<double> zero = zeros(*system);
  for (int i = 0; i < 3; ++i) {
    s.shake(0.05);
    const std::vector<double> d = s.random(s.q_typ),
                              r = residual(*system, s.q, zero, zero);
    const auto energy = [&](double e) {
      return std::vector<double>{
          system->energetics()->energy(t0, plus(s.q, e, d), zero).potential};
    };
    double work = 0;
    for (std::size_t k = 0; k < s.n; ++k) work += r[k] * d[k];
    // Truncation as tangent_tolerance has it; rounding eps E/e is 1e-12 E.
    const double now = energy(0)[0];
    EXPECT_GT(std::abs(work), 0.01 * now);
    EXPECT_NEAR(central_difference(difference_step, energy)[0], work,
                tangent_tolerance * now);
  }
}

TEST_P(CurledSprings, TangentIsExactWithFrictionOnATurningRoot) {
  const auto system = GetParam().make(
      {{"motion", "shake_rotate"}, {"internal_friction_kg_m3_s", "1e-9"}});
  States s(*system);
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
    s.shake(0.05);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance);
  }
}

TEST_P(CurledSprings, EnergyChangesByThePowerOfFrictionAndTheRoot) {
  const auto system = GetParam().make(
      {{"motion", "shake_rotate"}, {"internal_friction_kg_m3_s", "1e-9"}});
  ExplicitForm* form = system->explicit_form();
  if (form == nullptr) GTEST_SKIP() << "with constraints: as the contract has it";
  Energetics& energetics = *system->energetics();
  States s(*system);
  s.shake(0.05);
  std::vector<double> a(s.n);
  ASSERT_EQ(form->acceleration(t0, s.q, s.v, a), Status::ok);
  const auto energy = [&](double e) {
    return std::vector<double>{
        energetics.energy(t0 + e, plus(plus(s.q, e, s.v), e * e / 2, a), plus(s.v, e, a))
            .total()};
  };
  // As in the contract: e^4 and eps/e relative to E/time, two digits of margin.
  const double time =
      std::min(largest(s.q_typ) / largest(s.v), largest(s.v) / largest(a));
  const double power = energetics.power(t0, s.q, s.v);
  const Energy now = energetics.energy(t0, s.q, s.v);
  const double scale = (now.kinetic + std::abs(now.potential)) / time;
  EXPECT_NEAR(central_difference(difference_step * time, energy)[0], power,
              1e-10 * scale);
  EXPECT_GT(std::abs(power), 1e-6 * scale);
}

INSTANTIATE_TEST_SUITE_P(
    MassSpring, CurledSprings,
    testing::Values(StrandCase{"angular", "mass_spring", curls},
                    StrandCase{"second_neighbour", "mass_spring",
                               with(curls, {{"bending", "second_neighbour"}})},
                    StrandCase{"lifted_curls",
                               "lifted_curls",
                               {{"elements", "8"},
                                {"natural_curvature_per_m", "40"},
                                {"natural_twist_per_m", "20"}}},
                    StrandCase{"inextensible", "inextensible_strand", curls}),
    [](const auto& tested) { return tested.param.name; });

// A strand of n edges has 3 n coordinates, n lengths, two directions at the wall, n - 1
// angles: n - 1 motions that no spring but the altitudes sees.
TEST(MassSpring, AltitudesHoldWhatAnglesLeaveFree) {
  for (const auto& [torsion, expected] : {std::pair{"none", 7}, {"altitude", 0}}) {
    const auto system = make_model(
        "mass_spring", with(curls, {{"torsion", torsion}, {"gravity_m_s2", "0"}}));
    std::vector<double> q = zeros(*system), v = q;
    system->initial_state(q, v);
    const Eigen::VectorXd values =
        symmetric_eigenvalues(dense_tangent(*system, q, {0, 0, 1}));
    // Free motions are left with rounding, eps of the largest; the softest spring with
    // EI/L^3 beside EA/l, 4e-8 l/L.
    const double largest = values.maxCoeff();
    int free = 0;
    for (const double value : values) free += std::abs(value) < 1e-13 * largest ? 1 : 0;
    EXPECT_EQ(free, expected) << torsion;
  }
}

class Springs : public testing::TestWithParam<const char*> {};

TEST_P(Springs, ClampedFrequenciesApproachTheBeamAtOrder2) {
  std::vector<double> sizes, errors[3];
  for (const int n : {10, 20, 40}) {
    sizes.push_back(1.0 / n);
    const std::vector<double> frequencies = bending_frequencies(
        GetParam(),
        with(thin_rod, {{"gravity_m_s2", "0"}, {"elements", std::to_string(n)}}));
    for (std::size_t mode = 0; mode < 3; ++mode) {
      const double off = frequencies[mode] * std::sqrt(line_density) / beam[mode] - 1;
      errors[mode].push_back(std::abs(off));
      std::printf("%s, N = %d, mode %zu: off by %.2e\n", GetParam(), n, mode + 1, off);
    }
  }
  for (const auto& of_mode : errors) {
    EXPECT_LE(of_mode.back(), 0.01);
    EXPECT_NEAR(log_log_slope(sizes, of_mode), 2, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(MassSpring, Springs,
                         testing::Values("mass_spring", "inextensible_strand"));

// A soft curl released straight, thrown into space with a spin of 10 rad/s.
TEST(MassSpring, MidpointKeepsMomentumAndEnergyToOrder2) {
  const ModelSettings thrown = {{"elements", "10"},
                                {"motion", "free"},
                                {"gravity_m_s2", "0"},
                                {"youngs_modulus_pa", "1e6"},
                                {"radius_m", "1e-3"},
                                {"natural_curvature_per_m", "20"},
                                {"natural_twist_per_m", "10"},
                                {"initial", "bent"},
                                {"initial_curvature_per_m", "-5"},
                                {"torsion", "altitude"}};
  expect_midpoint_keeps("mass_spring", thrown,
                        {0.5e-3, 0.25e-3, 0.125e-3, 0.0625e-3, 0.03125e-3}, 1e-9);
}

Eigen::MatrixXd tangent_of(const char* word, const std::vector<double>& q) {
  const auto system =
      make_model("mass_spring", with(curls, {{"jacobian", word}, {"gravity_m_s2", "0"}}));
  return dense_tangent(*system, q, {0, 0, 1});
}

TEST(MassSpring, FilteredTangentIsPositiveSemidefiniteUnderCompression) {
  const auto system = make_model("mass_spring", curls);
  States s(*system);
  const Eigen::MatrixXd exact_at_rest = tangent_of("exact", s.q);
  // At rest no spring pushes: the same but for rounding and Hinge::delta.
  EXPECT_LE((tangent_of("filtered", s.q) - exact_at_rest).cwiseAbs().maxCoeff(),
            1e-14 * exact_at_rest.cwiseAbs().maxCoeff());
  for (double& x : s.q) x *= 0.5;  // all edges half as long
  for (int i = 0; i < 3; ++i) {
    s.shake(0.05);
    const Eigen::MatrixXd exact = tangent_of("exact", s.q);
    const Eigen::MatrixXd filtered = tangent_of("filtered", s.q);
    const double largest = filtered.cwiseAbs().maxCoeff();
    EXPECT_LE((filtered - filtered.transpose()).cwiseAbs().maxCoeff(), 1e-14 * largest);
    EXPECT_GE(symmetric_eigenvalues(filtered).minCoeff(), -1e-14 * largest);
    EXPECT_LE(symmetric_eigenvalues(exact).minCoeff(), -0.1 * largest);
  }
}

}  // namespace tress::test_mass_spring
