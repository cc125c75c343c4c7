#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrators/stage.h"
#include "tests/support/catalogue_cases.h"

namespace tress {
namespace {

using namespace testing_support;

CatalogueCase catalogue_case(std::string_view id, const char* key, const char* word) {
  return {&find_model(id), key, word};
}

/// A backward Euler step far too long for one Newton iteration.
constexpr double h = 0.03;

class StageSolution : public testing::TestWithParam<CatalogueCase> {
 protected:
  void SetUp() override {
    system_ = GetParam().make();
    state_.emplace(*system_);
    state_->v = state_->random(state_->v_typ);
    if (state_->m > 0) options_.formulation = Formulation::index3;
    q_bar_ = plus(state_->q, h, state_->v);
    a_.assign(state_->n, 0.0);
    lambda_.assign(state_->m, 0.0);
  }

  std::unique_ptr<System> system_;
  std::optional<States> state_;
  Options options_;
  const Weights w_{1, h, h* h};
  std::vector<double> q_bar_, a_, lambda_;
};

TEST_P(StageSolution, SatisfiesTheEquations) {
  Dynamics dynamics(*system_, options_);
  Stage stage(dynamics, options_);
  std::vector<double> r(state_->n), c(state_->m), r_start(state_->n), c_start(state_->m);
  ASSERT_EQ(dynamics.residual(h, q_bar_, state_->v, a_, lambda_, r_start, c_start),
            Status::ok);
  ASSERT_EQ(stage.solve(h, q_bar_, state_->v, w_, a_, lambda_), Status::ok);
  EXPECT_GT(dynamics.stats.newton_iterations, 2);
  ASSERT_EQ(dynamics.residual(h, stage.q(), stage.v(), a_, lambda_, r, c), Status::ok);
  // The last correction was at most newton_tolerance over the scales; Newton squares what
  // is left, so two digits of margin for the ratios between scales are plenty.
  EXPECT_LE(largest(r), 1e2 * options_.newton_tolerance * largest(r_start));
  if (state_->m > 0) {
    ASSERT_GT(scaled_norm(c_start, dynamics.g_typ()), 1e-6);
    EXPECT_LE(scaled_norm(c, dynamics.g_typ()), 1e-2 * options_.newton_tolerance);
  }
}

TEST_P(StageSolution, ConvergesQuadraticallyWithTheExactTangent) {
  Dynamics dynamics(*system_, options_);
  Stage stage(dynamics, options_);
  ASSERT_EQ(stage.solve(h, q_bar_, state_->v, w_, a_, lambda_), Status::ok);
  const std::vector<double> solution = a_;
  std::ranges::fill(a_, 0.0);
  std::ranges::fill(lambda_, 0.0);
  std::vector<double> errors;
  for (int i = 0; i < 12; ++i) {
    ASSERT_EQ(stage.single_step(h, q_bar_, state_->v, w_, a_, a_, lambda_), Status::ok);
    const double error = scaled_norm(plus(a_, -1, solution), state_->a_typ);
    if (error < 1e-9) break;  // the accuracy of the solution compared with
    errors.push_back(error);
  }
  // An error e below one becomes C e^2; a fixed fraction per iteration would be linear.
  ASSERT_GE(errors.size(), 2U);
  const double last = errors.back(), before = errors[errors.size() - 2];
  EXPECT_LE(last, 0.1 * before) << "before " << before;
  EXPECT_LE(last, 100 * before * before) << "before " << before;
}

INSTANTIATE_TEST_SUITE_P(
    Models, StageSolution,
    testing::Values(catalogue_case("double_pendulum", "", ""),
                    catalogue_case("bead_on_wire", "form", "implicit"),
                    catalogue_case("bead_on_wire", "curve", "helix"),
                    catalogue_case("inextensible_chain", "", ""),
                    catalogue_case("tinkertoys", "structure", "tree")),
    [](const auto& test) { return test.param.name(); });

}  // namespace
}  // namespace tress
