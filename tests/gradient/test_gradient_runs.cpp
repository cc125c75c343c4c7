#include <gtest/gtest.h>

#include <map>
#include <ostream>

#include "tests/gradient/strand_runs.h"

namespace tress::test_gradient_runs {

using namespace testing_support;

// A soft thick strand, as in tests/integrators/test_strands.cpp, on a root that
// translates and turns, with drag: every term of the equations is alive.
constexpr double end_time = 0.05, step = 0.0025;  // s

/// Whether joints of the model have no bending direction where they are straight. Such a
/// strand starts in its natural shape, others straight, out of it.
bool kinked(const ModelEntry& model) {
  return model.id == "mass_spring" || model.id == "inextensible_strand" ||
         model.id == "lifted_curls";
}

struct Case {
  const ModelEntry* model;
  std::string method;
  std::string name() const { return std::string(model->id) + "_" + method; }
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name(); }  // NOLINT

std::vector<Varied> varied(const Case& c) {
  const double curvature = kinked(*c.model) ? 25 : 8;
  return {{"youngs_modulus_pa", 1e6, 1e6},
          {"internal_friction_kg_m3_s", 1e-8, 1e-8},
          {"drag_kg_m_s", 2e-3, 2e-3},
          {"density_kg_m3", 1300, 1300},
          {"natural_curvature_per_m", curvature, 10},
          {"radius_m", 1e-3, 1e-3}};
}

StrandRun run_of(const Case& c) {
  StrandRun run{c.model, {}, c.method, {}, {}};
  run.settings = {{"elements", c.model->id == "super_clothoid" ? "1" : "3"},
                  {"natural_curvature2_per_m", "5"},
                  {"initial", kinked(*c.model) ? "natural" : "straight"},
                  {"motion", "shake_rotate"},
                  {"coupling", "1"},
                  {"norm", "1"},
                  {"edge_inertia", "0.5"}};
  for (const Varied& one : varied(c)) {
    run.settings.emplace_back(one.key, number_text(one.value));
  }
  run.options.step = step;
  run.options.newton_tolerance = 1e-13;  // below what differences of runs see
  if (run.make()->layout().constraints > 0) {
    run.options.formulation = Formulation::index3;
  }
  for (int k = 1; k <= 5; ++k) run.stops.push_back(k * end_time / 5);
  return run;
}

/// Why the method cannot run the model; empty: it can.
std::string reason_against(const Case& c) {
  const StrandRun run = run_of(c);
  return refusal(find_integrator(c.method), *run.make(), run.options.formulation);
}

/// Every model of strands with every method with stages.
std::vector<Case> pairs() {
  std::vector<Case> all;
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    for (const std::string& method : stage_methods()) all.push_back({&model, method});
  }
  return all;
}

std::vector<Case> cases() {
  std::vector<Case> all = pairs();
  std::erase_if(all, [](const Case& c) { return !reason_against(c).empty(); });
  return all;
}

/// Pairs that cannot run, with the reason: models with constraints, which only index3
/// differentiates (test_constraints.cpp).
const std::map<std::string, std::string> left_out{
    {"dynamic_spline_implicit_midpoint", "Gauss methods are unstable on index 3"},
    {"inextensible_strand_implicit_midpoint", "Gauss methods are unstable on index 3"}};

TEST(GradientPairs, LeaveOutThoseThatCannotRunAlone) {
  std::map<std::string, std::string> found;
  std::size_t models = 0;
  for (const ModelEntry& model : model_catalogue()) {
    models += model.on_strand != nullptr ? 1 : 0;
  }
  for (const Case& c : pairs()) {
    const std::string reason = reason_against(c);
    if (!reason.empty()) found[c.name()] = reason;
    const StrandRun run = run_of(c);
    EXPECT_EQ(no_gradient(c.method, *run.make(), run.options).has_value(),
              !reason.empty())
        << c.name();
  }
  EXPECT_EQ(found, left_out);
  EXPECT_EQ(cases().size() + left_out.size(), models * stage_methods().size());
}

class GradientOf : public testing::TestWithParam<Case> {};

// Differences at e = 1e-3: e^4 = 1e-12 times derivatives of order 5, and rounding of some
// 1e-13 L over e, 1e-10 of derivatives of 0.1 L and more.
TEST_P(GradientOf, IsThatOfDifferencesOfRuns) {
  const StrandRun run = run_of(GetParam());
  const std::vector<Varied> all = varied(GetParam());
  const TipGradient found = tip_gradient(run, all);
  ASSERT_EQ(found.failure, "");
  EXPECT_EQ(found.value, tips(run, {}, 0)) << "the run itself is not that of the method";
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::vector<double> by_runs = difference(run, all[k], 1e-3);
    EXPECT_GT(largest_of(by_runs), 1e-5) << all[k].key;
    EXPECT_LT(apart(found.by[k], by_runs), 1e-7) << all[k].key;
    std::vector<double> wrong = found.by[k];
    for (double& entry : wrong) entry = -entry;
    EXPECT_GT(apart(wrong, by_runs), 1) << all[k].key;
  }
}

// Both are exact for the same run. They differ by rounding, and by the differences of
// residuals in both: 1e-10 of their entries (ResidualDerivative).
TEST_P(GradientOf, BackwardIsThatForward) {
  const StrandRun run = run_of(GetParam());
  const std::vector<RunParameter> all = parameters(run, varied(GetParam()));
  const TipGradient forward = tip_gradient(run, all);
  const TipGradient backward = adjoint_tip_gradient(run, all);
  ASSERT_EQ(backward.failure, "");
  EXPECT_EQ(backward.value, forward.value);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_LT(apart(backward.by[k], forward.by[k]), 1e-7) << varied(GetParam())[k].key;
  }
}

// Motion depends on ratios of E (with G), friction, drag and density alone.
TEST_P(GradientOf, IsZeroAlongAChangeOfAllForcesAndMasses) {
  const TipGradient found = tip_gradient(run_of(GetParam()), varied(GetParam()));
  ASSERT_EQ(found.failure, "");
  double worst = 0, all = 0;
  for (std::size_t i = 0; i < found.value.size(); ++i) {
    double sum = 0, sizes = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      sum += found.by[k][i];
      sizes += std::abs(found.by[k][i]);
    }
    worst = std::max(worst, std::abs(sum));
    all = std::max(all, sizes);
  }
  EXPECT_GT(all, 1e-4);
  EXPECT_LT(worst, 1e-8 * all);
}

INSTANTIATE_TEST_SUITE_P(Strands, GradientOf, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.name(); });

}  // namespace tress::test_gradient_runs
