#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "integrators/catalogue.h"
#include "integrators/sundials/arkode_ark.h"
#include "tests/support/apart.h"
#include "tests/support/compliant.h"
#include "tests/support/drive.h"

namespace tress::test_additive {

using namespace experiments;
using namespace integrators;
using namespace testing_support;

constexpr double t_end = .02;  // s

/// Springs with internal friction whose root shakes, with drag at this rate.
std::unique_ptr<System> dragged(const char* rate) {
  return make_model("mass_spring", {{"elements", "3"},
                                    {"radius_m", "1e-3"},
                                    {"natural_curvature_per_m", "8"},
                                    {"youngs_modulus_pa", "1e6"},
                                    {"internal_friction_kg_m3_s", "1e-8"},
                                    {"mass_damping_per_s", rate},
                                    {"motion", "shake_rotate"}});
}

std::vector<double> end_of(std::string_view id, System& system, const Options& options,
                           long* steps = nullptr) {
  Drive drive(id, system, options);
  EXPECT_EQ(drive.to(t_end), Status::ok) << drive.integrator->failure();
  if (steps != nullptr) *steps = drive.integrator->stats().steps;
  return {drive.integrator->q().begin(), drive.integrator->q().end()};
}

Options tight() {
  Options options;
  options.rtol = 1e-12;
  options.atol = 1e-14;
  return options;
}

TEST(Additive, PartsSumToTheAcceleration) {
  const auto system = dragged("50");
  ElasticPart elastic(*system);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n), whole(n), part(n), rest(n), r(n);
  system->initial_state(q, v);
  for (std::size_t i = 0; i < n; ++i) v[i] += 0.1 * static_cast<double>(i + 1);
  ASSERT_EQ(system->explicit_form()->acceleration(0, q, v, whole), Status::ok);
  ASSERT_EQ(system->compliance_form()->rest(0, q, v, rest), Status::ok);
  ASSERT_EQ(elastic.explicit_form()->acceleration(0, q, v, part), Status::ok);
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(part[i], whole[i] - rest[i]);
  // Drag is in the explicit part, and the implicit residual vanishes without it.
  EXPECT_LT(rest.back(), -1);
  ASSERT_EQ(elastic.residual(0, q, v, part, r), Status::ok);
  double force = 0;
  ASSERT_EQ(system->residual(0, q, v, std::vector<double>(n), rest), Status::ok);
  for (const double entry : rest) force = std::max(force, std::abs(entry));
  for (const double entry : r) EXPECT_LE(std::abs(entry), 1e-12 * force);
}

// Steps of the longest length that is allowed: a tolerance of 1 never shortens one.
TEST(Additive, ErrorFallsAtTheOrder) {
  const auto system = dragged("50");
  const std::vector<double> exact = end_of("gsl_rk8pd", *system, tight());
  for (const int order : {3, 4, 5}) {
    std::vector<double> steps, errors;
    for (const double h : {1e-3, 5e-4, 2.5e-4}) {
      Options options;
      options.rtol = options.atol = 1;
      options.newton_coefficient = 1e-13;
      options.max_step = h;
      options.max_order = order;
      steps.push_back(h);
      errors.push_back(apart(end_of("arkode_ark", *system, options), exact));
      std::printf("order %d, step %g s: %.2e\n", order, h, errors.back());
    }
    EXPECT_NEAR(log_log_slope(steps, errors), order, 0.5) << order;
  }
}

TEST(Additive, FollowsTheTolerance) {
  const auto system = dragged("50");
  const std::vector<double> exact = end_of("gsl_rk8pd", *system, tight());
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    Options options;
    options.rtol = tolerance;
    options.atol = tolerance / 100;
    const double error = apart(end_of("arkode_ark", *system, options), exact);
    std::printf("rtol %g: %.1e\n", tolerance, error);
    EXPECT_LE(error, 10 * tolerance);
  }
}

// An explicit method of order 4 is stable for drag rates up to about 3 over the step, an
// implicit one for all.
TEST(Additive, StrongDragLimitsTheStep) {
  const auto system = dragged("1e5");
  Options options;
  options.rtol = 1e-3;
  options.atol = 1e-5;
  long additive = 0, implicit = 0;
  end_of("arkode_ark", *system, options, &additive);
  end_of("arkode_dirk", *system, options, &implicit);
  std::printf("%ld steps, fully implicit %ld\n", additive, implicit);
  EXPECT_GE(additive, static_cast<long>(1e5 * t_end / 5));
  EXPECT_LE(implicit, additive / 5);
}

TEST(Additive, RefusesModelsWithoutCompliancesAndOtherOrders) {
  const auto helix = make_model("super_helix", {});
  EXPECT_EQ(refusal(find_integrator("arkode_ark"), *helix, Formulation::parametric),
            "needs the model's energy as compliant constraints");
  const auto system = dragged("0");
  for (const int order : {2, 6}) {
    Options options;
    options.max_order = order;
    EXPECT_THROW((void)make_integrator("arkode_ark", *system, options), InputError);
  }
}

}  // namespace tress::test_additive
