#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "experiments/stability_limit/stability_limit.h"

namespace tress::test_nodal_limits {

using namespace experiments;
using namespace experiments::stability_limit;

using Set = std::vector<std::pair<std::string, std::string>>;

CommandLine line(const Set& set = {}) {
  CommandLine asked;
  asked.quick = true;
  asked.set = set;
  return asked;
}

std::vector<Case> nodal(const CommandLine& asked) {
  return nodal_cases(asked, Settings(asked, stability_settings()));
}

std::size_t grid_rows(const CommandLine& asked) {
  return stability_cases(asked, Settings(asked, stability_settings())).size();
}

TEST(NodalLimits, AreRowsOfTheirOwn) {
  std::set<std::string> names;
  for (const Case& row : nodal(line())) {
    EXPECT_EQ(row.identity.text("study"), "nodal");
    names.insert(run_id("stability_limit", row.identity));
  }
  EXPECT_EQ(names.size(), 24u);  // six ways to step at four numbers of nodes
}

TEST(NodalLimits, AreLeftOutWhereOtherRowsAreAskedFor) {
  for (const Set& set : {Set{{"study", "grid"}}, Set{{"scene", "shake"}},
                         Set{{"damping", "light"}}, Set{{"solver", "recursive"}}}) {
    EXPECT_TRUE(nodal(line(set)).empty()) << set.front().first;
    EXPECT_GT(grid_rows(line(set)), 0u) << set.front().first;
  }
  EXPECT_EQ(grid_rows(line({{"study", "nodal"}})), 0u);
  CommandLine one = line({{"jacobian", "exact"}});
  one.integrators = {"rk4"};
  one.elements = {7, 9};
  ASSERT_EQ(nodal(one).size(), 2u);
  EXPECT_EQ(nodal(one).front().identity.number("elements"), 7);
  one.models = {"der"};
  EXPECT_TRUE(nodal(one).empty());
}

// velocity_verlet on a grid: dt omega <= 2 for the highest frequency, that of twist.
TEST(NodalLimits, OfExplicitStepsIsThatOfTheGrid) {
  CommandLine asked = line();
  asked.integrators = {"velocity_verlet"};
  asked.elements = {20};
  const std::vector<Case> all = nodal(asked);
  ASSERT_EQ(all.size(), 1u);
  Row row = all.front().identity;
  all.front().run(row, Deadline(600));
  ASSERT_TRUE(row.ok()) << row.text("reason");
  EXPECT_NEAR(row.number("dt_max_s") / row.number("dt_theory_s"), 1, 0.06);
  EXPECT_LT(row.number("dt_theory_s"), row.number("dt_bending_s"));
  EXPECT_TRUE(row.has("at_claim"));
}

Row found(std::string_view integrator, std::string_view start, int elements, double dt,
          std::string_view at_claim) {
  Row row;
  row.set("study", "nodal").set("integrator", integrator).set("start", start);
  row.set("elements", elements).set("dt_max_s", dt).set("at_claim", at_claim);
  return row;
}

std::vector<Verdicts::State> states(const std::vector<Row>& rows) {
  Verdicts verdicts;
  check_nodal_claims(rows, verdicts);
  std::vector<Verdicts::State> all;
  for (const auto& verdict : verdicts.all()) all.push_back(verdict.state);
  return all;
}

constexpr auto held = Verdicts::State::held, broken = Verdicts::State::broken,
               unjudged = Verdicts::State::not_judged;

TEST(NodalClaims, SpeakOfTwoHundredNodes) {
  EXPECT_EQ(states({}), std::vector<Verdicts::State>(6, unjudged));
  const auto at = [](int nodes, std::string_view broke) {
    return states({found("linearly_implicit_midpoint", "space", nodes, 1e-6, broke)})[0];
  };
  EXPECT_EQ(at(200, "energy"), held);
  EXPECT_EQ(at(200, "nothing"), broken);
  EXPECT_EQ(at(100, "energy"), unjudged);
}

// Other rows with the same words, of the grid, are none of theirs.
TEST(NodalClaims, LeaveTheGridAlone) {
  Row other = found("linearly_implicit_midpoint", "space", 200, 1e-6, "nothing");
  EXPECT_EQ(states({other.set("study", "grid")})[0], unjudged);
}

TEST(NodalClaims, FollowTheSlopeAndTheTheory) {
  const auto slope = [](double order) {
    std::vector<Row> rows;
    for (const int n : {20, 50, 100}) {
      rows.push_back(
          found("linearly_implicit_midpoint", "plane", n, std::pow(n, order), ""));
    }
    return states(rows)[4];
  };
  EXPECT_EQ(slope(-2), held);
  EXPECT_EQ(slope(-1.5), broken);
  const auto theory = [](double ratio) {
    Row row = found("rk4", "space", 20, ratio * 1e-5, "energy");
    return states({row.set("dt_theory_s", 1e-5)})[5];
  };
  EXPECT_EQ(theory(0.97), held);
  EXPECT_EQ(theory(0.93), broken);
}

}  // namespace tress::test_nodal_limits
