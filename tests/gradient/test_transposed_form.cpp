#include <gtest/gtest.h>

#include <cmath>

#include "contract/forms/transposed_form.h"
#include "integrators/gradient/probe.h"
#include "linear/vector_ops.h"
#include "tests/gradient/strand_runs.h"

namespace tress::test_transposed_form {

using namespace testing_support;

/// A hair with every kind of term that has rates or constants.
StrandRun hair(const std::string& model) {
  StrandRun run{&find_model(model), {}, "backward_euler", {}, {}};
  run.settings = {{"elements", model == "super_clothoid" ? "2" : "4"},
                  {"initial", "straight"},
                  {"internal_friction_kg_m3_s", "1e-9"},
                  {"drag_kg_m_s", "5e-5"},
                  {"natural_curvature_per_m", "18"},
                  {"motion", "shake"},
                  {"amplitude_m", "0.005"},
                  {"frequency_hz", "3"}};
  return run;
}

/// A state away from the start, and numbers without a pattern.
struct State : integrators::Probe {
  using Probe::Probe;
  std::vector<double> numbers(double seed) const {
    std::vector<double> x(q.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = std::cos(seed + 3.1 * static_cast<double>(i));
    }
    return x;
  }
  double t = 0.0137;
};

double sizes_of(In x, In y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += std::abs(x[i] * y[i]);
  return sum;
}

class TransposedFormOf : public testing::TestWithParam<std::string> {};

// mu . c = b . S^-1 c: both sums lose what S^-1 does, some 1e5 roundings.
TEST_P(TransposedFormOf, SolvesWithTheTransposedMatrix) {
  const auto system = hair(GetParam()).make();
  TransposedForm* const form = transposed_form(*system);
  ASSERT_NE(form, nullptr);
  const State at(*system);
  constexpr double h = 2e-3;
  constexpr Weights w{1, h, h * h};
  const std::vector<double> b = at.numbers(1), c = at.numbers(5);
  std::vector<double> mu(b.size()), by_q(mu), by_v(mu), x(mu);
  ASSERT_TRUE(form->factor_transposed(at.t, at.q, at.v, at.a, w));
  ASSERT_EQ(form->solve_transposed(b, mu, by_q, by_v), Status::ok);
  ASSERT_EQ(system->linearize(at.t, at.q, at.v, at.a, w), Status::ok);
  ASSERT_EQ(system->solve(c, x), Status::ok);
  EXPECT_NEAR(scalar_product(mu, c), scalar_product(b, x), 1e-10 * sizes_of(b, x));
}

// Against central differences at 1e-6 of typical sizes: 1e-12 times third derivatives,
// and rounding of 1e-16 of the terms of r, of which dr is at least 1e-3, over 1e-6.
TEST_P(TransposedFormOf, MultipliesWithTheDerivativesOfTheResidual) {
  const auto system = hair(GetParam()).make();
  TransposedForm* const form = transposed_form(*system);
  const State at(*system);
  constexpr double h = 2e-3, e = 1e-6;
  const std::vector<double> b = at.numbers(1), change = at.numbers(7);
  const std::size_t n = b.size();
  std::vector<double> mu(n), by_q(n), by_v(n), plus(n), minus(n);
  ASSERT_TRUE(form->factor_transposed(at.t, at.q, at.v, at.a, {1, h, h * h}));
  ASSERT_EQ(form->solve_transposed(b, mu, by_q, by_v), Status::ok);
  for (const bool of_v : {false, true}) {
    SCOPED_TRACE(of_v ? "by v" : "by q");
    std::vector<double> q_plus = at.q, q_minus = at.q, v_plus = at.v, v_minus = at.v,
                        d(n);
    for (std::size_t i = 0; i < n; ++i) {
      d[i] = change[i] * (of_v ? at.v_typ[i] : at.q_typ[i]);
      (of_v ? v_plus : q_plus)[i] += e * d[i];
      (of_v ? v_minus : q_minus)[i] -= e * d[i];
    }
    ASSERT_EQ(system->residual(at.t, q_plus, v_plus, at.a, plus), Status::ok);
    ASSERT_EQ(system->residual(at.t, q_minus, v_minus, at.a, minus), Status::ok);
    double by_differences = 0, sizes = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double term = mu[i] * (plus[i] - minus[i]) / (2 * e);
      by_differences += term;
      sizes += std::abs(term);
    }
    EXPECT_NEAR(scalar_product(of_v ? by_v : by_q, d), by_differences, 1e-6 * sizes);
  }
}

// What acts through constants or loads costs a sweep nothing or a load; all else is left
// to differences of residuals.
TEST_P(TransposedFormOf, KnowsWhatActsThroughConstantsAndLoads) {
  const StrandRun run = hair(GetParam());
  const auto system = run.make();
  const auto of = [&](const char* key, double value, double unit) {
    return constants_derivative(*system, run.parameter({key, value, unit}));
  };
  for (const auto& [key, value] :
       {std::pair{"youngs_modulus_pa", 3e9}, std::pair{"internal_friction_kg_m3_s", 1e-9},
        std::pair{"density_kg_m3", 1300.0}, std::pair{"radius_m", 4e-5},
        std::pair{"natural_curvature_per_m", 18.0}}) {
    SCOPED_TRACE(key);
    // From a winding of 1 rad on, an element of a clothoid has more points.
    const bool bends = std::string_view(key) == "natural_curvature_per_m";
    const auto found = of(key, value, bends ? 0.1 : value);
    ASSERT_TRUE(found.has_value());
    EXPECT_GT(largest_of(found->by), 0);
    EXPECT_TRUE(found->loads.systems.empty());
  }
  const auto drag = of("drag_kg_m_s", 5e-5, 5e-5);
  ASSERT_TRUE(drag.has_value());
  EXPECT_EQ(largest_of(drag->by), 0);
  EXPECT_EQ(drag->loads.systems.size(), 1u);
  // The clamp's motion is known to reduced coordinates.
  const bool reduced = GetParam() != "der";
  const auto amplitude = of("amplitude_m", 0.005, 0.005);
  ASSERT_EQ(amplitude.has_value(), reduced);
  if (!reduced) return;
  EXPECT_EQ(largest_of(amplitude->by), 0);
  EXPECT_EQ(amplitude->clamp.systems.size(), central_stencil.at.size());
  EXPECT_TRUE(amplitude->moves_points);
  EXPECT_FALSE(amplitude->loads.systems.empty());
}

// Contact may begin later. Viscous drag always acts, and the clamp's motion is known.
TEST_P(TransposedFormOf, ViscousForcesGiveAClampNoLoads) {
  if (GetParam() == "der") GTEST_SKIP() << "its clamp is not known in closed form";
  const StrandRun run = hair(GetParam());
  const auto found = constants_derivative(
      *run.make(), run.parameter({"amplitude_m", 0.005, 0.005}), {.quadratic = true});
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->clamp.systems.empty());
  EXPECT_TRUE(found->loads.systems.empty());
}

INSTANTIATE_TEST_SUITE_P(Models, TransposedFormOf,
                         testing::Values("super_helix", "super_clothoid",
                                         "articulated_chain", "der"),
                         [](const auto& c) { return c.param; });

}  // namespace tress::test_transposed_form
