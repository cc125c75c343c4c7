#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/constraint_drift/constraint_drift.h"
#include "experiments/stability_limit/stability_limit.h"

namespace tress::test_stability_claims {

using namespace experiments;
using namespace experiments::constraint_drift;
using namespace experiments::stability_limit;

Row row(std::string_view scene, std::string_view integrator, std::string_view solver,
        std::string_view jacobian, double stable, double unstable) {
  Row r;
  r.set("scene", scene).set("model", "super_helix").set("integrator", integrator);
  r.set("solver", solver).set("jacobian", jacobian).set("modes", "bend_twist");
  r.set("elements", 20).set("damping", "none");
  return r.set("dt_max_s", stable).set("dt_first_unstable_s", unstable);
}

Row linearly_implicit(std::string_view solver, double stable, double unstable,
                      std::string_view jacobian = "elastic") {
  return row("whip", "linearly_implicit_euler", solver, jacobian, stable, unstable);
}

constexpr double none = std::numeric_limits<double>::infinity();  // an empty cell

std::vector<Verdicts::Verdict> all_of(const std::vector<Row>& rows) {
  Verdicts all;
  check_stability_claims(rows, all);
  return all.all();
}

/// Without the claims whose rows were not run.
std::vector<Verdicts::Verdict> verdicts(const std::vector<Row>& rows) {
  std::vector<Verdicts::Verdict> judged = all_of(rows);
  std::erase_if(judged, [](const Verdicts::Verdict& verdict) {
    return verdict.state == Verdicts::State::not_judged;
  });
  return judged;
}

TEST(StabilityClaims, BracketsThatOverlapAreTheSameLimit) {
  const auto same = verdicts({linearly_implicit("recursive", 1.00, 1.05),
                              linearly_implicit("composite", 1.04, 1.09)});
  ASSERT_EQ(same.size(), 1u);
  EXPECT_TRUE(same[0].held);
  EXPECT_DOUBLE_EQ(same[0].value, 1.04);
  for (const auto& [recursive, composite] : {std::pair{1.00, 1.06}, {1.06, 1.00}}) {
    const auto other =
        verdicts({linearly_implicit("recursive", recursive, 1.05 * recursive),
                  linearly_implicit("composite", composite, 1.05 * composite)});
    ASSERT_EQ(other.size(), 1u);
    EXPECT_FALSE(other[0].held);
    EXPECT_DOUBLE_EQ(other[0].value, 1.06);
  }
}

TEST(StabilityClaims, ALimitAtTheCapIsAboveEveryOther) {
  EXPECT_TRUE(verdicts({linearly_implicit("recursive", 0.1, none),
                        linearly_implicit("composite", 0.1, none)})[0]
                  .held);
  EXPECT_FALSE(verdicts({linearly_implicit("recursive", 0.1, none),
                         linearly_implicit("composite", 0.08, 0.084)})[0]
                   .held);
}

TEST(StabilityClaims, LessImplicitMayBeBelowStiffButNotAbove) {
  EXPECT_TRUE(verdicts({linearly_implicit("recursive", 1.00, 1.05),
                        linearly_implicit("recursive", 0.01, 0.0105, "elastic_local")})[0]
                  .held);
  EXPECT_FALSE(verdicts({linearly_implicit("recursive", 1.00, 1.05),
                         linearly_implicit("recursive", 1.05, 1.10, "elastic_local")})[0]
                   .held);
}

// A search that ran out of time at 0.6 cannot have met a limit of 0.5; one that went on
// to 0.4 should have.
TEST(StabilityClaims, SearchesAreComparedWhereBothGotTo) {
  const auto compared = [](double finest) {
    Row cut = linearly_implicit("recursive", 1.00, 1.05);
    cut.set("search_done", false).set("dt_finest_s", finest);
    return verdicts({cut, linearly_implicit("composite", 0.5, 0.52)});
  };
  EXPECT_TRUE(compared(0.6).empty());
  ASSERT_EQ(compared(0.4).size(), 1u);
  EXPECT_FALSE(compared(0.4)[0].held);
}

TEST(StabilityClaims, RowsWithoutALimitSayNothing) {
  Row failed = linearly_implicit("recursive", 5, 6);
  failed.failed("gave_up", "");
  EXPECT_TRUE(verdicts({failed, linearly_implicit("composite", 1, 2)}).empty());
  EXPECT_TRUE(verdicts({linearly_implicit("recursive", 1, 2)}).empty());
}

TEST(StabilityClaims, TheShakenStrandDecidesOnTheTwoTangents) {
  const auto shaken = [](double implicit, double semi) {
    return verdicts({row("shake", "backward_euler", "recursive", "exact", implicit, none),
                     row("shake", "linearly_implicit_euler", "recursive", "elastic", semi,
                         1.05 * semi)});
  };
  const auto good = shaken(0.033, 0.0019), bad = shaken(0.0329, 0.002);
  ASSERT_EQ(good.size(), 2u);
  ASSERT_EQ(bad.size(), 2u);
  EXPECT_TRUE(good[0].held && good[1].held);
  EXPECT_FALSE(bad[0].held || bad[1].held);
}

// Five claims: of two solvers, of two Jacobians, of the shaken strand by two Jacobians,
// and of tolerances.
TEST(StabilityClaims, OfRowsThatWereNotRunAreNotJudged) {
  const auto unjudged = all_of({linearly_implicit("recursive", 1, 2)});
  ASSERT_EQ(unjudged.size(), 5u);
  for (const auto& verdict : unjudged) {
    EXPECT_EQ(verdict.state, Verdicts::State::not_judged) << verdict.claim;
    EXPECT_FALSE(verdict.alarm());
  }
}

// A row that was run and found no limit does not hold what is claimed of it.
TEST(StabilityClaims, ARowThatGaveUpBreaksItsClaim) {
  Row failed = row("shake", "backward_euler", "recursive", "exact", 0.1, none);
  const auto all = verdicts({failed.failed("gave_up", "")});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].alarm());
}

// A run that stopped kept no length: it breaks the claim unless that is known of it.
TEST(DriftClaims, ARunThatStoppedIsNotPassedOver) {
  const auto state = [](std::string_view system, std::string_view variant) {
    Row stopped;
    stopped.set("study", "strands").set("system", system).set("variant", variant);
    stopped.set("integrator", "predictor_corrector").set("dt_s", 1.0 / 120);
    Verdicts all;
    check_drift_claims({stopped.set("steps", 6).failed("solver_error", "")}, all);
    for (const auto& verdict : all.all()) {
      if (verdict.state != Verdicts::State::not_judged) return verdict.state;
    }
    return Verdicts::State::not_judged;
  };
  EXPECT_EQ(state("inextensible_strand", "stretch_springs=linear"),
            Verdicts::State::broken);
  EXPECT_EQ(state("inextensible_strand", ""), Verdicts::State::known_limit);
}

}  // namespace tress::test_stability_claims
