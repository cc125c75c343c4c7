#include <gtest/gtest.h>

#include <cmath>

#include "experiments/constraint_drift/constraint_drift.h"

namespace tress::test_feedback_limits {

using namespace experiments;
using namespace experiments::constraint_drift;

std::vector<Case> limits(const CommandLine& line) {
  return feedback_limits(line, Settings(line, {}));
}

/// The row at critical damping, run.
Row critical(std::string_view integrator,
             const std::vector<std::pair<std::string, std::string>>& set = {}) {
  CommandLine line;
  line.integrators = {std::string(integrator)};
  line.set = set;
  for (const Case& of : limits(line)) {
    if (std::abs(of.identity.number("zeta") - 1) > 1e-9) continue;
    Row row = of.identity;
    of.run(row, Deadline(600));
    return row;
  }
  return {};
}

// 2 (sqrt 2 - 1) is the known limit of symplectic Euler; as a number of steps it is the
// same at any step.
TEST(FeedbackLimits, AreThoseOfTheTestEquation) {
  for (const char* step : {"1e-3", "2e-3"}) {
    const Row row = critical("symplectic_euler", {{"step", step}});
    ASSERT_TRUE(row.ok()) << row.text("reason");
    EXPECT_EQ(row.text("study"), "limit");
    EXPECT_EQ(row.number("dt_s"), std::stod(step));
    EXPECT_NEAR(row.number("omega_h_predicted"), 2 * (std::sqrt(2.0) - 1), 1e-6);
    EXPECT_LT(std::abs(row.number("rel_gap")), 0.05);
  }
}

TEST(FeedbackLimits, AreNotMetByAnAStableMethod) {
  const Row row = critical("backward_euler");
  EXPECT_TRUE(row.ok()) << row.text("reason");
  EXPECT_FALSE(row.has("omega_h_predicted"));
}

TEST(FeedbackLimits, AreThoseOfABead) {
  CommandLine line;
  line.models = {"inextensible_chain"};
  EXPECT_TRUE(limits(line).empty());
}

TEST(FeedbackLimits, AreClaimedToFivePerCent) {
  const auto state = [](double gap) {
    Row row;
    row.set("study", "limit").set("integrator", "rk4").set("zeta", 1.0);
    Verdicts verdicts;
    check_drift_claims({row.set("rel_gap", gap)}, verdicts);
    for (const auto& verdict : verdicts.all()) {
      if (verdict.claim.ends_with("limit within 5 % of theory")) return verdict.state;
    }
    return Verdicts::State::not_judged;
  };
  EXPECT_EQ(state(-0.04), Verdicts::State::held);
  EXPECT_EQ(state(-0.06), Verdicts::State::broken);
}

}  // namespace tress::test_feedback_limits
