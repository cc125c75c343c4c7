#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <sstream>

#include "contract/forms/compliance_form.h"
#include "contract/forms/constraint_form.h"
#include "experiments/numerics/fit.h"
#include "experiments/problems/strand_models.h"
#include "integrators/integrator_options.h"
#include "models/catalogue.h"
#include "tests/support/drive.h"
#include "tests/support/tested.h"

namespace tress::test_strands {

using namespace experiments;

using testing_support::Drive;

// A soft thick strand (its waves take milliseconds, so that explicit methods are in their
// asymptotic range) on a root that translates and turns, with drag: every term of the
// equations is alive.
constexpr double checkpoints[] = {0.01, 0.02, 0.03, 0.04, 0.05};  // s
constexpr double end_time = 0.05;

struct Method {
  const IntegratorEntry* entry;
  std::string_view model;
  std::string name() const { return std::string(entry->id) + "_" + std::string(model); }
};

void PrintTo(const Method& method, std::ostream* out) {
  *out << method.name();
}  // NOLINT

std::unique_ptr<System> strand(std::string_view model) {
  const ModelEntry& entry = find_model(model);
  Parameters p(setup_parameters(entry), "model " + std::string(model));
  if (p.knows("elements")) {
    p.set("elements", model == "super_clothoid" ? "1" : "3");  // waves as slow
    p.set("radius_m", "1e-3");
    // Joints that stay bent where their dihedral angles jump if they are straightened.
    p.set("natural_curvature_per_m", model == "lifted_curls" ? "25" : "8");
    p.set("natural_curvature2_per_m", "5");
    p.set("youngs_modulus_pa", "1e6");
  } else {  // the palm tree is of wood: softened until it sways like the strand
    p.set("youngs_modulus_pa", "1e5");
  }
  // Penalties and quaternions as slow as the rest.
  set_known(p, {{"coupling", "1"}, {"norm", "1"}, {"edge_inertia", "0.5"}});
  p.set("mass_damping_per_s", "2");
  p.set("motion", "shake_rotate");
  return entry.make(p);
}

/// The state at the checkpoints, by an explicit method of order 8 on the explicit form.
const std::vector<std::vector<double>>& reference(std::string_view model) {
  static std::map<std::string_view, std::vector<std::vector<double>>> known;
  auto& states = known[model];
  if (!states.empty()) return states;
  const auto system = strand(model);
  Options options;
  options.rtol = 1e-13;
  options.atol = 1e-13;
  Drive drive("gsl_rk8pd", *system, options);
  for (const double t : checkpoints) {
    EXPECT_EQ(drive.to(t), Status::ok) << drive.integrator->failure();
    states.emplace_back(drive.integrator->q().begin(), drive.integrator->q().end());
  }
  return states;
}

struct Outcome {
  double error;  // largest of a coordinate over the checkpoints, over its typical size
  long steps;
};

Outcome run(const Method& method, const Options& options) {
  const auto system = strand(method.model);
  Drive drive(method.entry->id, *system, options);
  std::vector<double> q_typ(drive.q0.size()), v_typ(q_typ.size());
  system->scale(q_typ, v_typ);
  double most = 0;
  for (std::size_t i = 0; i < std::size(checkpoints); ++i) {
    EXPECT_EQ(drive.to(checkpoints[i]), Status::ok) << drive.integrator->failure();
    most = std::max(most, drive.distance(reference(method.model)[i]) / q_typ.front());
  }
  return {most, drive.integrator->stats().steps};
}

/// Every strand model without constraints (those are the formulations' business), and
/// trees. Not of plug-ins, whose waves nobody knows.
std::vector<std::string_view> tested_models() {
  std::vector<std::string_view> all{"super_helix_tree"};
  for (const ModelEntry* model : strand_models()) {
    if (std::ranges::count(added_models(), model->id, &ModelEntry::id) > 0) continue;
    if (strand(model->id)->constraint_form() == nullptr) all.push_back(model->id);
  }
  return all;
}

/// A rod whose sections have no rotary inertia, not the one here: test_block_descent.cpp.
constexpr std::string_view of_another_rod = "stable_cosserat_rods";

std::vector<Method> methods(bool adaptive) {
  std::vector<Method> all;
  for (const std::string_view model : tested_models()) {
    const auto system = strand(model);
    for (const IntegratorEntry& entry : testing_support::tested_integrators()) {
      if (entry.adaptive != adaptive || entry.id == of_another_rod) continue;
      if (!refusal(entry, *system, Formulation::parametric).empty()) continue;
      all.push_back({&entry, model});
    }
  }
  return all;
}

TEST(Strands, OnlyRattlePredictorCorrectorAndMethodsOfCompliancesAreRefused) {
  // The first two are for constraints; the others, position-based methods, arkode_ark and
  // arkode_mri, drive what is a sum of compliant ones.
  constexpr std::size_t of_compliances = 7;
  std::size_t expected = 0;
  for (const std::string_view model : tested_models()) {
    const bool compliant = strand(model)->compliance_form() != nullptr;
    expected += integrator_catalogue().size() - (compliant ? 3 : 2 + of_compliances);
  }
  EXPECT_EQ(methods(false).size() + methods(true).size(), expected);
}

class FixedStepOnStrands : public testing::TestWithParam<Method> {};

TEST_P(FixedStepOnStrands, ErrorFallsAtTheNominalOrder) {
  std::vector<double> steps, errors;
  std::ostringstream tried;
  // Methods of order one come to their asymptotic range later.
  const int order = GetParam().entry->order();
  // rodas5p loses the strand at longer steps.
  const bool solves_once = GetParam().entry->id == "rodas5p";
  int coarsest = order == 1 ? 1000 : order > 4 ? 40 : 100;
  if (solves_once) coarsest = GetParam().model == "articulated_chain" ? 160 : 80;
  // At these steps few sweeps leave less than the step does.
  const bool sweeps =
      std::ranges::count(readers_of_option("sweeps"), GetParam().entry) > 0;
  for (int i = 0; i < (solves_once ? 3 : 4); ++i) {
    Options options;
    if (sweeps) apply(options, "sweeps", "3", "test");
    // An iteration that converges linearly leaves an error of its tolerance.
    if (order > 4) options.newton_tolerance = 1e-13;
    options.step = end_time / (coarsest * std::pow(2, i));
    const double error = run(GetParam(), options).error;
    tried << "\nstep " << options.step << " s: error " << error;
    // Order 5 lies between steps that miss the fastest waves, with which errors fall
    // faster, and the error of the reference, whose steps have 1e-13.
    if (order > 4 && (error > 1e-4 || error < 1e-11)) continue;
    steps.push_back(options.step);
    errors.push_back(error);
  }
  ASSERT_GE(errors.size(), 2u) << tried.str();
  if (order > 4) {
    // Errors C h^p (1 - x), 1 - x/2 at half the step: 0.4 is lost where the term of the
    // next order has x = 0.39 of the leading one.
    EXPECT_GE(log_log_slope(steps, errors), order - 0.4) << tried.str();
    return;
  }
  // The coarsest step may still be longer than the fastest waves.
  const auto last = [](const std::vector<double>& x) { return std::span(x).subspan(1); };
  EXPECT_NEAR(log_log_slope(last(steps), last(errors)), order, 0.25) << tried.str();
}

INSTANTIATE_TEST_SUITE_P(Catalogue, FixedStepOnStrands, testing::ValuesIn(methods(false)),
                         [](const auto& test) { return test.param.name(); });

class AdaptiveOnStrands : public testing::TestWithParam<Method> {};

TEST_P(AdaptiveOnStrands, ErrorFollowsTheTolerance) {
  for (const double rtol : {1e-4, 1e-6, 1e-8}) {
    Options options;
    options.rtol = rtol;
    options.atol = rtol / 10;
    // Order 2, its default, keeps rtol^(2/3) of the error (OrderTwoBdf).
    if (GetParam().entry->id == "cvode_bdf") options.max_order = 5;
    const Outcome outcome = run(GetParam(), options);
    // Local errors of rtol each add up; few steps are given the factor 100 of test_order.
    const auto factor = static_cast<double>(std::max(100L, outcome.steps));
    EXPECT_LE(outcome.error, factor * rtol) << "rtol " << rtol;
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, AdaptiveOnStrands, testing::ValuesIn(methods(true)),
                         [](const auto& test) { return test.param.name(); });

}  // namespace tress::test_strands
