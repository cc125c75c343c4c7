#include <gtest/gtest.h>

#include <ostream>

#include "tests/gradient/strand_runs.h"

/// Gradients of runs with constraints g(q; s) = 0 that depend on the parameter.
namespace tress::test_constraints {

using namespace testing_support;

struct Case {
  std::string model, method;
  Varied varied;
  ModelSettings settings;
};

void PrintTo(const Case& c, std::ostream* out) {  // NOLINT
  *out << c.model << "_" << c.method;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const std::string& method : stage_methods()) {
    if (method == "implicit_midpoint") continue;  // unstable on index 3
    all.push_back({"inextensible_chain", method, {"length_m", 1, 1}, {{"links", "4"}}});
    all.push_back({"tinkertoys", method, {"length_m", 1, 1}, {{"structure", "net"}}});
    all.push_back({"bead_on_wire", method, {"pitch_m", 0.5, 0.5}, {{"curve", "helix"}}});
  }
  return all;
}

StrandRun run_of(const Case& c) {
  StrandRun run{&find_model(c.model), c.settings, c.method, {}, {}};
  run.settings.emplace_back(c.varied.key, number_text(c.varied.value));
  run.options.step = 0.0025;
  run.options.newton_tolerance = 1e-13;
  run.options.formulation = Formulation::index3;
  run.stops = {0.1};
  return run;
}

/// q at the end.
std::vector<double> end_of(const StrandRun& run, const std::string& key, double value) {
  const auto system = run.make(key, value);
  std::vector<double> q(static_cast<std::size_t>(system->layout().coordinates)), v(q);
  system->initial_state(q, v);
  const auto method = make_integrator(run.method, *system, run.options);
  EXPECT_EQ(method->start(0, q, v), Status::ok);
  EXPECT_EQ(method->advance(run.stops.back()), Status::ok) << method->failure();
  return {method->q().begin(), method->q().end()};
}

class GradientWithConstraints : public testing::TestWithParam<Case> {};

// Differences at e = 1e-3: e^4 = 1e-12 times derivatives of order 5, and rounding of some
// 1e-13 over e.
TEST_P(GradientWithConstraints, IsThatOfDifferencesOfRuns) {
  const StrandRun run = run_of(GetParam());
  const Varied& varied = GetParam().varied;
  const auto system = run.make();
  ASSERT_GT(system->layout().constraints, 0);
  const std::vector<RunParameter> parameters{run.parameter(varied)};
  GradientRun gradient(*system, run.make(), parameters, {run.method, run.options});
  ASSERT_EQ(gradient.start(), Status::ok) << gradient.failure();
  ASSERT_EQ(gradient.advance(run.stops.back()), Status::ok) << gradient.failure();
  constexpr double e = 1e-3;
  std::vector<double> by_runs(gradient.q().size());
  constexpr double at[] = {-2, -1, 1, 2}, weight[] = {1, -8, 8, -1};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::vector<double> q =
        end_of(run, varied.key, varied.value + at[k] * e * varied.unit);
    for (std::size_t i = 0; i < q.size(); ++i) by_runs[i] += weight[k] / (12 * e) * q[i];
  }
  EXPECT_GT(largest_of(by_runs), 1e-3);
  const In dq = gradient.dq(0);
  EXPECT_LT(apart({dq.begin(), dq.end()}, by_runs), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Systems, GradientWithConstraints, testing::ValuesIn(cases()),
                         [](const auto& c) {
                           return c.param.model + "_" + c.param.method;
                         });

TEST(GradientWithConstraints, IsRefusedButForIndex3) {
  const auto system =
      find_model("inextensible_chain")
          .make(Parameters(setup_parameters(find_model("inextensible_chain")), "model"));
  for (const std::string& method : stage_methods()) {
    for (const Formulation formulation :
         {Formulation::acceleration, Formulation::baumgarte, Formulation::projection}) {
      Options options;
      options.formulation = formulation;
      const auto no = no_gradient(method, *system, options);
      ASSERT_TRUE(no) << method;
      const bool takes =
          refusal(find_integrator(method), *system, Formulation::index3).empty();
      EXPECT_EQ(takes, no->remedy == "use formulation = \"index3\"") << method;
      EXPECT_EQ(no->remedy.find("implicit_midpoint"), std::string::npos) << method;
    }
  }
  EXPECT_NE(refusal(find_integrator("implicit_midpoint"), *system, Formulation::index3),
            "");
}

}  // namespace tress::test_constraints
