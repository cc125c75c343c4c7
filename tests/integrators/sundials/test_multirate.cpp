#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "experiments/problems/strand_models.h"
#include "integrators/catalogue.h"
#include "integrators/sundials/arkode_mri.h"
#include "tests/support/apart.h"
#include "tests/support/compliant.h"
#include "tests/support/drive.h"

namespace tress::test_multirate {

using namespace experiments;
using namespace integrators;
using namespace testing_support;

constexpr double t_end = .02;  // s
constexpr int elements = 4;

/// A curl with drag and internal friction whose root shakes.
std::unique_ptr<System> curl(std::string_view model) {
  return make_model(model, {{"elements", std::to_string(elements)},
                            {"radius_m", "2e-4"},
                            {"natural_curvature_per_m", "8"},
                            {"youngs_modulus_pa", "1e6"},
                            {"internal_friction_kg_m3_s", "1e-10"},
                            {"mass_damping_per_s", "50"},
                            {"motion", "shake_rotate"}});
}

std::vector<double> end_of(std::string_view id, System& system, const Options& options,
                           Status expected = Status::ok) {
  Drive drive(id, system, options);
  EXPECT_EQ(drive.to(t_end), expected) << drive.integrator->failure();
  return {drive.integrator->q().begin(), drive.integrator->q().end()};
}

TEST(Multirate, PartsSumToTheAcceleration) {
  for (const models::ModelEntry* entry : strand_models()) {
    const std::string_view model = entry->id;
    const auto system = curl(model);
    if (system->compliance_form() == nullptr) continue;
    FastRows rows(*system);
    std::printf("%s: %d of %d rows are fast, to %.3g 1/s\n", std::string(model).c_str(),
                rows.fast_rows(), rows.rows(), rows.fastest());
    const auto n = static_cast<std::size_t>(system->layout().coordinates);
    std::vector<double> q(n), v(n), whole(n), fast(n), slow(n);
    system->initial_state(q, v);
    for (std::size_t i = 0; i < n; ++i) {
      q[i] += 1e-6 * static_cast<double>(i * i % 7);
      v[i] += 1e-3 * static_cast<double>(i % 5 + 1);
    }
    constexpr double t = 0.003;
    ASSERT_EQ(system->explicit_form()->acceleration(t, q, v, whole), Status::ok);
    ASSERT_EQ(system->compliance_form()->rest(t, q, v, slow), Status::ok);
    rows.add(false, t, q, v, slow);
    rows.add(true, t, q, v, fast);
    double largest = 0, moved = 0;
    for (std::size_t i = 0; i < n; ++i) {
      largest = std::max({largest, std::abs(fast[i]), std::abs(slow[i])});
      moved = std::max(moved, std::abs(fast[i]));
    }
    EXPECT_GT(moved, 0);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(fast[i] + slow[i], whole[i], 1e-11 * largest) << model << ' ' << i;
    }
  }
}

// Springs between neighbours, and springs that bend and twist, of 4 elements.
TEST(Multirate, StretchIsFast) {
  const auto springs = curl("mass_spring");
  const FastRows rows(*springs);
  EXPECT_EQ(rows.fast_rows(), elements);
  EXPECT_GT(rows.rows(), elements);
}

// The equations are linear: the largest frequency of n masses on springs is
// 2 sqrt(k/m) cos(pi/(2 n)), and the bound that of an endless line.
TEST(Multirate, BoundOfTheFastRates) {
  constexpr double stiffness = 400;
  for (const int masses : {3, 12}) {
    MassLine line(masses, stiffness, 0);
    EXPECT_NEAR(FastRows(line).fastest(), 2 * std::sqrt(stiffness), 1e-9);
  }
  MassLine damped(5, stiffness, 3);
  EXPECT_NEAR(FastRows(damped).fastest(), 2 * std::sqrt(stiffness) + 4 * 3, 1e-9);
}

TEST(Multirate, ErrorFallsAtTheOrder) {
  Options tight;
  tight.rtol = 1e-12;
  tight.atol = 1e-15;
  for (const auto& [model, longest] :
       {std::pair("mass_spring", 5e-4), std::pair("lifted_curls", 2.5e-4)}) {
    const auto system = curl(model);
    const std::vector<double> exact = end_of("gsl_rk8pd", *system, tight);
    for (const int order : {3, 4}) {
      std::vector<double> steps, errors;
      for (const double h : {longest, longest / 2, longest / 4}) {
        Options options;
        options.step = h;
        options.max_order = order;
        options.own = {{"fast_steps", "40"}};
        steps.push_back(h);
        errors.push_back(apart(end_of("arkode_mri", *system, options), exact));
        std::printf("%s, order %d, step %g s: %.2e\n", model, order, h, errors.back());
      }
      EXPECT_NEAR(log_log_slope(steps, errors), order, 0.5) << model << order;
    }
  }
}

// Bending, not stretch, limits the slow step: one at which rk4 is unstable has the error
// of rk4 with steps that stretch allows.
TEST(Multirate, SlowStepsAreLongerThanStretchAllows) {
  const auto system = curl("mass_spring");
  Options tight;
  tight.rtol = 1e-10;
  tight.atol = 1e-13;
  const std::vector<double> exact = end_of("gsl_rk8pd", *system, tight);
  const double longest = 2.83 / FastRows(*system).fastest();
  Options options;
  options.step = 4 * longest;
  const double error = apart(end_of("arkode_mri", *system, options), exact);
  std::printf("slow step %g s, %g times that of rk4: error %.1e\n", options.step,
              options.step / longest, error);
  EXPECT_LT(error, 1e-2);
  Drive unstable("rk4", *system, options);
  const bool ended = unstable.to(t_end) != Status::ok;
  EXPECT_TRUE(ended ||
              apart({unstable.integrator->q().begin(), unstable.integrator->q().end()},
                    exact) > 1);
}

TEST(Multirate, RefusesModelsWithoutCompliancesRigidRowsAndOtherOrders) {
  const auto helix = make_model("super_helix", {});
  EXPECT_EQ(refusal(find_integrator("arkode_mri"), *helix, Formulation::parametric),
            "needs the model's energy as compliant constraints");
  const auto system = curl("mass_spring");
  for (const int order : {2, 5}) {
    Options options;
    options.step = 1e-4;
    options.max_order = order;
    EXPECT_THROW((void)make_integrator("arkode_mri", *system, options), InputError);
  }
}

}  // namespace tress::test_multirate
