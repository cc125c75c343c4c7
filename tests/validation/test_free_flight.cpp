#include <gtest/gtest.h>

#include <set>

#include "contract/input_error.h"
#include "experiments/validation/free_flight.h"
#include "experiments/validation/table.h"

namespace tress::test_free_flight {

using namespace experiments;
using namespace experiments::validation;

CommandLine line(const std::vector<std::string>& integrators = {}) {
  CommandLine asked;
  asked.quick = true;
  asked.integrators = integrators;
  return asked;
}

std::vector<Case> cases(const CommandLine& asked) {
  return validation_cases(asked, Settings(asked, validation_settings()));
}

std::set<std::string> tests_of(const CommandLine& asked) {
  std::set<std::string> names;
  for (const Case& of : cases(asked)) names.emplace(of.identity.text("test"));
  return names;
}

TEST(FreeFlight, IsChosenLikeAnyTest) {
  EXPECT_TRUE(tests_of(line()).contains("free_flight"));
  CommandLine asked = line();
  asked.set = {{"tests", "free_flight"}};
  EXPECT_EQ(tests_of(asked), std::set<std::string>{"free_flight"});
  asked.set = {{"tests", "cantilever"}};
  EXPECT_EQ(tests_of(asked), std::set<std::string>{"cantilever"});
}

// It alone has integrators to choose from, and no parameter.
TEST(FreeFlight, IsWhatIntegratorsSelect) {
  EXPECT_EQ(tests_of(line({"rk4"})), std::set<std::string>{"free_flight"});
  CommandLine asked = line({"rk4"});
  asked.set = {{"tests", "cantilever"}};
  EXPECT_THROW(cases(asked), InputError);
  asked = line();
  asked.set = {{"tests", "free_flight"}, {"parameters", "1"}};
  EXPECT_THROW(cases(asked), InputError);
}

/// The rows of mass_spring by this method, run.
std::vector<Row> flown(const std::string& integrator) {
  CommandLine asked = line({integrator});
  asked.models = {"mass_spring"};
  std::vector<Row> rows;
  for (const Case& of : cases(asked)) {
    Row row = of.identity;
    of.run(row, Deadline(600));
    rows.push_back(row);
  }
  return rows;
}

// Momentum is linear in q and v, and angular momentum bilinear: the midpoint rule keeps
// both of particles. Backward Euler keeps the first only, and loses energy.
TEST(FreeFlight, ShowsWhatIntegratorsKeep) {
  const std::vector<Row> midpoint = flown("implicit_midpoint"),
                         damped = flown("backward_euler");
  ASSERT_EQ(midpoint.size(), 2u);
  ASSERT_EQ(damped.size(), 2u);
  // At the longer step its springs have no solution.
  EXPECT_LT(midpoint[1].number("linear_error_rel"), 1e-9);
  EXPECT_LT(midpoint[1].number("angular_error_rel"), 1e-9);
  EXPECT_LT(damped[0].number("linear_error_rel"), 1e-9);
  EXPECT_LT(damped[0].number("angular_change_rel"), -0.01);
  EXPECT_LT(damped[0].number("energy_change_rel"), -0.01);
  EXPECT_GT(damped[1].number("angular_change_rel"),
            damped[0].number("angular_change_rel"));  // at a tenth of the step
}

TEST(FreeFlight, ClaimsFailWhereARowDoes) {
  const auto states = [](double damped, double kept) {
    const auto row = [](std::string_view integrator, double error) {
      Row r;
      r.set("test", "free_flight").set("model", "mass_spring");
      r.set("integrator", integrator).set("dt_s", 1 / 120.0);
      return r.set("angular_error_rel", error);
    };
    Verdicts verdicts;
    check_free_flight({row("backward_euler", damped), row("implicit_midpoint", kept)},
                      verdicts);
    return std::pair{verdicts.all().at(0).held, verdicts.all().at(1).held};
  };
  EXPECT_EQ(states(0.02, 1e-10), (std::pair{true, true}));
  EXPECT_EQ(states(0.005, 1e-8), (std::pair{false, false}));
  Verdicts none;
  check_free_flight({}, none);
  for (const auto& verdict : none.all()) {
    EXPECT_EQ(verdict.state, Verdicts::State::not_judged);
  }
}

}  // namespace tress::test_free_flight
