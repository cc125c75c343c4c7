#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "contract/input_error.h"
#include "experiments/validation/free_flight.h"
#include "experiments/validation/table.h"

namespace tress::test_table {

using namespace experiments;
using namespace experiments::validation;

Row row(std::string_view model, int elements, double error, bool judged) {
  Row r;
  r.set("test", "cantilever").set("model", model).set("elements", elements);
  r.set("parameter", 10.0).set("error_rel", error).set("judged", judged);
  return r;
}

CommandLine line(std::vector<std::pair<std::string, std::string>> set = {}) {
  CommandLine all;
  all.quick = true;
  all.set = std::move(set);
  return all;
}

std::vector<Case> cases(const CommandLine& of) {
  return validation_cases(of, Settings(of, validation_settings()));
}

TEST(ValidationTable, HasEveryTestOfEveryModel) {
  std::set<std::pair<std::string, std::string>> seen;
  CommandLine usual = line();
  usual.quick = false;  // a plectoneme takes too long for a quick table
  for (const Case& c : cases(usual)) {
    if (c.identity.text("test") == free_flight) continue;  // integrator by integrator
    seen.emplace(c.identity.text("test"), c.identity.text("model"));
  }
  EXPECT_EQ(seen.size(), validation_tests().size() * strand_models().size());
}

TEST(ValidationTable, TakesTestsAndParametersAsAsked) {
  CommandLine asked = line({{"tests", "cantilever"}, {"parameters", "0.2;700"}});
  asked.models = {"der"};
  asked.elements = {7};
  std::set<double> parameters;
  for (const Case& c : cases(asked)) {
    EXPECT_EQ(c.identity.text("test"), "cantilever");
    EXPECT_EQ(c.identity.number("elements"), 7);
    parameters.insert(c.identity.number("parameter"));
  }
  EXPECT_EQ(parameters, (std::set<double>{0.2, 700}));
  EXPECT_THROW(cases(line({{"tests", "cantilver"}})), InputError);
  for (const char* wrong : {"-1", "1e6", "nan"}) {
    EXPECT_THROW(cases(line({{"tests", "cantilever"}, {"parameters", wrong}})),
                 InputError);
  }
  EXPECT_THROW(cases(line({{"tests", "heavy_chain"}, {"parameters", "4"}})), InputError);
  EXPECT_THROW(cases(line({{"tests", "beam_modes"}, {"parameters", "1.5"}})), InputError);
}

TEST(ValidationTable, FitsOrdersOverElements) {
  std::vector<Row> rows{row("der", 10, 4e-2, false), row("der", 20, 1e-2, false),
                        row("der", 40, 2.5e-3, true), row("der", 80, 1e-12, true),
                        row("corde", 40, 1e-2, true)};
  fit_validation_orders(rows);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rows[i].number("order"), 2, 1e-12);
  EXPECT_FALSE(rows[3].has("order"));  // rounding
  EXPECT_FALSE(rows[4].has("order"));  // one point
}

TEST(ValidationTable, ClaimsFailWhereAJudgedRowDoes) {
  const auto verdict = [](double error, bool judged) {
    Verdicts verdicts;
    check_validation({row("der", 10, 0.5, false), row("der", 40, 1e-4, true),
                      row("der", 80, error, judged)},
                     verdicts);
    std::size_t judged_claims = 0;
    bool held = false;
    for (const auto& claim : verdicts.all()) {
      if (claim.state == Verdicts::State::not_judged) continue;
      ++judged_claims;
      held = claim.held;
    }
    EXPECT_EQ(judged_claims, 1u);
    EXPECT_GT(verdicts.all().size(), 100u);  // of all tests and models
    return held;
  };
  EXPECT_TRUE(verdict(9e-3, true));
  EXPECT_FALSE(verdict(2e-2, true));
  EXPECT_TRUE(verdict(2e-2, false));
  EXPECT_FALSE(verdict(std::nan(""), true));  // no answer
}

// It was run and has no answer, whatever it does not say of itself.
TEST(ValidationTable, AKilledRowBreaksItsClaim) {
  Row killed;
  killed.set("test", "cantilever").set("model", "der").set("elements", 40);
  Verdicts verdicts;
  check_validation({killed.failed("timeout", "killed")}, verdicts);
  EXPECT_EQ(std::ranges::count_if(verdicts.all(), &Verdicts::Verdict::alarm), 1);
}

TEST(ValidationTable, ReferencesAreWhatTestsHangOn) {
  CommandLine asked = line({{"tests", "cantilever"}, {"parameters", "1"}});
  asked.models = {"super_helix"};
  asked.elements = {10};
  const std::vector<Case> all = cases(asked);
  ASSERT_EQ(all.size(), 1u);
  Row measured = all.front().identity;
  all.front().run(measured, Deadline(60));
  EXPECT_EQ(measured.status(), "ok");
  EXPECT_LT(measured.number("error_rel"), 0.01);
  EXPECT_GT(
      std::abs(measured.number("measured") / (1.05 * measured.number("reference")) - 1),
      measured.number("accepted_error_rel"));
}

}  // namespace tress::test_table
