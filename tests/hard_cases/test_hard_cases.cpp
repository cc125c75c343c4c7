#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "contract/input_error.h"
#include "experiments/hard_cases/gauges.h"
#include "experiments/hard_cases/hard_cases.h"
#include "models/effects/body.h"

namespace tress::test_hard_cases {

using namespace experiments;
using namespace experiments::hard_cases;

using testing::HasSubstr;

const HardCase& named(std::string_view name) {
  for (const HardCase& hard : hard_case_catalogue()) {
    if (hard.name == name) return hard;
  }
  throw std::runtime_error("no case " + std::string(name));
}

Parameters defaults(std::string_view model) {
  return {setup_parameters(find_model(model)), "test"};
}

Subject subject(std::string_view model, ModelSettings settings = {}) {
  return {&find_model(model), std::move(settings), ""};
}

Situation made(std::string_view hard, std::string_view model = "super_helix",
               ModelSettings settings = {}) {
  return situation(named(hard), subject(model, std::move(settings)), defaults(model));
}

Survival survived(std::string_view hard, std::string_view model,
                  std::string_view integrator, const Pace& pace, const Reference& exact) {
  const Attempt attempt{
      &named(hard), subject(model), defaults(model), integrator, pace, {}, 1e-3};
  return survive(attempt, {}, [&] { return exact; });
}

Survival survived(std::string_view hard, std::string_view model,
                  std::string_view integrator, double dt, const Reference& exact = {}) {
  return survived(hard, model, integrator, Pace{dt}, exact);
}

// ---- the list -----------------------------------------------------------------------

TEST(HardCases, SayWhatTheyAreAndWhenTheyArePassed) {
  std::set<std::string_view> names;
  for (const HardCase& hard : hard_case_catalogue()) {
    EXPECT_TRUE(names.insert(hard.name).second) << hard.name;
    EXPECT_FALSE(hard.why.empty()) << hard.name;
    EXPECT_FALSE(hard.measure.empty()) << hard.name;
    EXPECT_FALSE(hard.criterion.empty()) << hard.name;
    EXPECT_NE(hard.bounds, nullptr) << hard.name;
    EXPECT_TRUE(hard.horizon == 0 || hard.count > 0 || hard.horizon <= hard.t_end)
        << hard.name;
  }
  EXPECT_GE(names.size(), 24U);
}

// Every model is in every situation, or says why not.
TEST(HardCases, AreMadeOnEveryModelOrRefused) {
  for (const HardCase& hard : hard_case_catalogue()) {
    if (hard.settings.empty() || !hard.not_for_strands.empty()) continue;
    for (const ModelEntry& model : model_catalogue()) {
      if (model.on_strand == nullptr) continue;
      try {
        const Situation s = situation(hard, {&model, {}, ""}, defaults(model.id));
        EXPECT_GT(s.mass, 0) << hard.name << " " << model.id;
        EXPECT_GT(s.length, 0) << hard.name << " " << model.id;
        EXPECT_EQ(s.start.q.size(),
                  static_cast<std::size_t>(s.system->layout().coordinates));
      } catch (const InputError& refused) {
        EXPECT_FALSE(std::string(refused.what()).empty());
      }
    }
  }
}

TEST(HardCases, HaveTheGeometryThatTheySay) {
  const Situation bead = made("heavy_tip");
  const Segment& last = bead.strand.segments.back();
  const double tip = bead.strand.material.density * last.section.area() * last.length;
  EXPECT_NEAR(tip / (bead.mass - tip), 1000, 1e-9 * 1000);

  const Situation vanishing = made("vanishing_element");
  EXPECT_NEAR(vanishing.length, 0.1, 1e-15);
  EXPECT_NEAR(vanishing.strand.segments[10].length / vanishing.strand.segments[0].length,
              1e-4, 1e-12);

  // Half a turn within one element.
  const Segment bent = made("folded").strand.segments[10];
  EXPECT_NEAR(bent.initial.y * bent.length, M_PI, 1e-14);

  // Turns about its middle: no linear momentum.
  const Situation free = made("million_steps", "der");
  const State rest = initial_state(*free.system);
  const Momentum momentum =
      free.system->energetics()->momentum(0, rest.q, rest.v).value();
  const double spun =
      std::hypot(momentum.angular[0], momentum.angular[1], momentum.angular[2]);
  for (const double p : momentum.linear) EXPECT_LE(std::abs(p), 1e-12 * spun / 0.1);

  // EI from the softest to the stiffest.
  const auto stiffness = [](const Situation& s) {
    return s.strand.material.youngs_modulus *
           s.strand.segments.front().section.inertia1();
  };
  EXPECT_GE(stiffness(made("stiffest")) / stiffness(made("softest")), 1e10);

  // Six turns per element.
  const Segment coil = made("turns_6_per_element").strand.segments.front();
  EXPECT_NEAR(std::sqrt(dot(coil.natural, coil.natural)) * coil.length / (2 * M_PI), 6,
              0.01);
}

// A tether that lets go at once would leave a case without what makes it hard.
TEST(HardCases, PullWhereTheySayThatTheyPull) {
  for (const auto& [hard, pull] :
       {std::pair{"buckling", 10 * M_PI * M_PI / 4 * 6.03e-9 / 0.01},
        {"coil_contact", 5e-6}}) {
    const Situation s = made(hard, "der");
    std::vector<double> x(3 * 2), v(6), load(6);
    const std::vector<double> one{1, 1};
    x[3] = 0.02;
    const Points p{2, x, v, {}, one, one};
    s.effects.back()->add_load(0.2, p, load);
    // Softened within 1 mm of its target: 0.1 % at 20 mm. EI of the hair to 0.1 %.
    EXPECT_NEAR(std::hypot(load[3], load[4], load[5]), pull, 2e-3 * pull) << hard;
  }
}

// A tenth of the length along the first link: that constraint is off by as much, of a
// scale that is the length.
TEST(HardCases, InconsistentStartsViolateTheirConstraints) {
  const ModelSettings links{{"links", "20"}, {"length_m", "0.1"}};
  const Situation s = made("inconsistent_start", "inextensible_chain", links);
  ConstraintForm& form = *s.system->constraint_form();
  std::vector<double> g(20), g_typ(20);
  ASSERT_EQ(form.value(0, s.start.q, g), Status::ok);
  form.scale(g_typ);
  // (l + 0.1 L)^2 - l^2 over 2 l, or the length itself: at least the length.
  EXPECT_GE(std::abs(g[0]), 0.0999 * g_typ[0] * 0.1);
  for (std::size_t k = 1; k < g.size(); ++k) EXPECT_LE(std::abs(g[k]), 1e-12);
}

// ---- the judge ----------------------------------------------------------------------

TEST(HardCaseJudge, PassesWhatIsRightAndFailsWhatIsNot) {
  Reference own;
  const double step = 1.0 / 300;
  own = reference(named("one_element"), subject("super_helix"), defaults("super_helix"),
                  {}, 1, {});
  ASSERT_EQ(own.why, "");
  EXPECT_EQ(
      survived("one_element", "super_helix", "implicit_midpoint", step, own).outcome,
      Outcome::accurate);
  // First order at a long step damps: stable, far from the reference.
  const Survival damped =
      survived("one_element", "super_helix", "backward_euler", 1.0 / 30, own);
  EXPECT_EQ(damped.outcome, Outcome::stable);
  EXPECT_THAT(damped.why, HasSubstr("error"));
  // An explicit method beyond its limit gains energy.
  const Survival wrong =
      survived("two_elements", "super_helix", "explicit_euler", 1.0 / 30, own);
  EXPECT_EQ(wrong.outcome, Outcome::unstable);
  EXPECT_THAT(wrong.why, HasSubstr("at t ="));
}

// Neither Newton's steps nor damped ones get there from any start; a step made longer bit
// by bit does.
TEST(HardCaseJudge, LongStepsOfSoftStrandsAreSolved) {
  EXPECT_EQ(survived("softest", "super_helix", "backward_euler", 1.0 / 30,
                     {{}, 0, "none needed"})
                .outcome,
            Outcome::stable);
}

TEST(HardCaseJudge, SaysWhyThereIsNoReferenceAndIsStableAtMost) {
  const Reference none{{}, 0, "lost"};
  const Survival s =
      survived("one_element", "super_helix", "implicit_midpoint", 1.0 / 300, none);
  EXPECT_EQ(s.outcome, Outcome::stable);
  EXPECT_EQ(s.why, "lost");
}

TEST(HardCaseJudge, RefusesInTheWordsOfTheLibrary) {
  const Survival no_free_root =
      survived("million_steps", "force_transport", "backward_euler", 1e-3);
  EXPECT_EQ(no_free_root.outcome, Outcome::refused);
  EXPECT_THAT(no_free_root.why, HasSubstr("free"));
  const Survival no_compliance = survived("straight", "super_helix", "xpbd", 1e-3);
  EXPECT_EQ(no_compliance.outcome, Outcome::refused);
  EXPECT_THAT(no_compliance.why, HasSubstr("compliant constraints"));
  // Without inertia about the tangent there is no M^-1.
  EXPECT_EQ(survived("straight", "super_helix", "rk4", 1e-3).outcome, Outcome::refused);
  EXPECT_EQ(survived("redundant_constraints", "der", "backward_euler", 1e-3).outcome,
            Outcome::refused);
  EXPECT_EQ(survived("inconsistent_start", "der", "backward_euler", 1e-3).outcome,
            Outcome::refused);
}

// Without them turns overlap by half of their radius; methods that cannot go on after
// them say so.
TEST(HardCaseJudge, ImpulsesKeepTurnsApart) {
  HardCase coil = named("coil_impulse");
  const auto run = [&](std::string_view integrator) {
    const Attempt attempt{
        &coil, subject("super_helix"), defaults("super_helix"), integrator, {1.0 / 300},
        {}};
    return survive(attempt, {}, [] { return Reference{}; });
  };
  for (const std::string_view able : {"linearly_implicit_euler", "backward_euler"}) {
    const Survival s = run(able);
    EXPECT_EQ(s.outcome, Outcome::stable) << s.why;
    EXPECT_LT(*s.measure, 0.01) << *s.measure;
  }
  EXPECT_EQ(run("bdf2").outcome, Outcome::refused);
  EXPECT_THAT(run("bdf2").why, HasSubstr("cannot go on after the impulses"));
  coil.impulses.reset();
  EXPECT_GT(*run("backward_euler").measure, 0.5);
}

// However long that takes: five steps of one iteration at least do not fit.
TEST(HardCaseJudge, StopsWhenItsWorkIsDone) {
  const Attempt attempt{&named("one_element"),
                        subject("super_helix"),
                        defaults("super_helix"),
                        "backward_euler",
                        {1.0 / 300},
                        {}};
  const WorkLimit little{5 * 2 * 3.0};  // residual and solve of three unknowns
  const auto run = [&] { return survive(attempt, little, [] { return Reference{}; }); };
  const Survival s = run();
  EXPECT_EQ(s.outcome, Outcome::not_finished);
  EXPECT_FALSE(passed(s.outcome));
  EXPECT_THAT(s.why, HasSubstr("its work was done at t = "));
  EXPECT_GT(s.stats.steps, 0);
  EXPECT_LE(s.stats.steps, 6);
  EXPECT_EQ(run().stats.steps, s.stats.steps);
}

// dt and dt/100 in turn: as many steps as the simulated time has of their sum, twice.
TEST(HardCaseJudge, StepsJump) {
  const Survival s = survived("step_jumps", "super_helix", "backward_euler", 0.01,
                              {{}, 0, "none needed"});
  EXPECT_EQ(s.outcome, Outcome::stable);
  const double pairs = 0.25 / 0.0101;
  EXPECT_NEAR(static_cast<double>(s.stats.steps), 2 * pairs, 2);
}

// ---- by tolerance -------------------------------------------------------------------

constexpr double longest = 1.0 / 30;

/// By tr_bdf2, against bdf2 at a fixed step of 0.25 ms, whose own error (gap) counts
/// twice: once as that of either.
TEST(HardCaseByTolerance, ErrorIsThatWhichIsAskedFor) {
  const HardCase& hard = named("two_elements");
  const Reference exact =
      reference(hard, subject("super_helix"), defaults("super_helix"), {}, 1, {});
  ASSERT_EQ(exact.why, "");
  ASSERT_LE(exact.gap, 1e-3);
  for (const double tolerance : {1e-2, 1e-3}) {
    const Survival s =
        survived("two_elements", "super_helix", "tr_bdf2", {longest, tolerance}, exact);
    EXPECT_EQ(s.outcome, Outcome::accurate) << s.why;
    EXPECT_NEAR(s.t, hard.t_end, 1e-12);
    EXPECT_LE(*s.error, tolerance + 2 * exact.gap);
  }
}

TEST(HardCaseByTolerance, StepsAreNoLongerThanAsked) {
  const Reference none{{}, 0, "none needed"};
  const auto steps = [&](double most) {
    return survived("two_elements", "super_helix", "tr_bdf2", {most, 1e-2}, none)
        .stats.steps;
  };
  const double t_end = named("two_elements").t_end;
  EXPECT_GE(static_cast<double>(steps(1e-3)), t_end / 1e-3);
  EXPECT_LT(static_cast<double>(steps(longest)), t_end / 1e-3);
}

// Of a case that counts steps: the time of so many of the longest.
TEST(HardCaseByTolerance, StepsThatAreCountedAreTheLongest) {
  const Survival s =
      survived("million_steps", "super_helix", "tr_bdf2", {1e-3, 1e-2}, {});
  EXPECT_NEAR(s.t, 1000 * 1e-3, 1e-9);  // a thousandth of them
  EXPECT_GE(s.stats.steps, 1000);
}

// Where a case says where steps end, the method keeps its own and is only asked there.
TEST(HardCaseByTolerance, StopsDoNotChangeTheSteps) {
  const HardCase& jumping = named("step_jumps");
  HardCase whole = jumping;
  whole.stops = [](double dt, double t_end) {
    return std::vector{named("step_jumps").stops(dt, t_end).back()};
  };
  Attempt attempt{&whole,    subject("super_helix"), defaults("super_helix"),
                  "tr_bdf2", {longest, 1e-3},        {}};
  const auto none = [] { return Reference{{}, 0, "none needed"}; };
  const Survival at_its_end = survive(attempt, {}, none);
  attempt.hard = &jumping;
  const Survival at_stops = survive(attempt, {}, none);
  EXPECT_EQ(at_its_end.outcome, Outcome::stable) << at_its_end.why;
  EXPECT_EQ(at_stops.outcome, Outcome::stable) << at_stops.why;
  EXPECT_EQ(at_stops.t, at_its_end.t);
  EXPECT_EQ(at_stops.stats.steps, at_its_end.stats.steps);
  EXPECT_EQ(at_stops.stats.residuals, at_its_end.stats.residuals);
}

// Error control has no index 3, which fixed steps prefer.
TEST(HardCaseByTolerance, ConstraintsAreHeldByProjection) {
  const Survival s = survived("two_elements", "inextensible_strand", "tr_bdf2",
                              {longest, 1e-2}, {{}, 0, "none needed"});
  EXPECT_EQ(s.outcome, Outcome::stable) << s.why;
  EXPECT_EQ(s.formulation, "projection");
}

TEST(HardCaseByTolerance, AToleranceThatCannotBeMetIsNoSurvival) {
  Attempt attempt{&named("two_elements"),  subject("super_helix"),
                  defaults("super_helix"), "tr_bdf2",
                  {longest, 1e-4},         {}};
  attempt.options.min_step = longest / 2;
  const Survival s = survive(attempt, {}, [] { return Reference{}; });
  EXPECT_EQ(s.outcome, Outcome::unstable);
  EXPECT_THAT(s.why, HasSubstr("tolerance 0.0001 needs a step below"));
}

TEST(HardCaseJudge, OutcomesAreReadAsTheyAreWritten) {
  for (const Outcome outcome : {Outcome::refused, Outcome::not_finished,
                                Outcome::unstable, Outcome::stable, Outcome::accurate}) {
    EXPECT_EQ(outcome_of(name(outcome), "test"), outcome);
  }
  EXPECT_THROW(static_cast<void>(outcome_of("fine", "test")), InputError);
}

// ---- what is measured ---------------------------------------------------------------

// A straight strand along x, over the slope 5 mm below: as deep as it is lowered.
TEST(HardCaseGauges, PenetrationIsDepthOverWhatIsAllowed) {
  Situation s = made("nearly_inextensible", "der");
  const BodyContact law{.stiffness = 1, .offset = 40e-6};
  s.effects.push_back(
      std::make_shared<Body>(Plane{}, StrandPlace{{0, 0, 1e-3}, {}}, law));
  const auto gauge = penetration_gauge(s);
  gauge->see(0, s.start.q, s.start.v);
  const Segment& last = s.strand.segments.back();
  const double allowed = last.section.a1 + 0.0694 * last.length;
  EXPECT_NEAR(gauge->measure(), (1e-3 + 40e-6) / allowed, 1e-9);
}

// Antiparallel halves half a circle of one element apart: 2 l/pi.
TEST(HardCaseGauges, OverlapIsThatOfPartsFarApartAlongTheStrand) {
  const Situation s = made("folded", "super_helix");
  const double l = 0.005, apart = 2 * l / M_PI;
  OverlapGauge gauge(s, 2 * apart, 4 * l);
  gauge.see(0, s.start.q, s.start.v);
  EXPECT_NEAR(gauge.measure(), 2 * (1 - 0.5), 1e-9);
  OverlapGauge nothing(s, 0.5 * apart, 4 * l);
  nothing.see(0, s.start.q, s.start.v);
  EXPECT_DOUBLE_EQ(nothing.measure(), 0);
}

TEST(HardCaseGauges, NumbersThatAreNotAreNotPassed) {
  Situation s = made("stiffest", "der");
  const auto sag = sag_gauge(s, 1);
  sag->see(0, s.start.q, s.start.v);
  EXPECT_LE(sag->measure(), 1e-12);
  s.start.q.back() = s.start.q[s.start.q.size() / 2] = std::nan("");
  for (double& x : s.start.q) x = std::nan("");
  sag->see(0, s.start.q, s.start.v);
  EXPECT_FALSE(sag->measure() <= 1);
}

// ---- references shared by processes, the grid and the claims --------------------------

TEST(HardCaseReferences, AreMadeOnce) {
  References references(2);
  int made = 0;
  const auto compute = [&] {
    ++made;
    return Reference{{1, 2, 3}, 0.5, ""};
  };
  EXPECT_EQ(references.get(1, 1, compute).tip, (std::vector<double>{1, 2, 3}));
  const Reference again = references.get(1, 1, compute);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(again.tip, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(again.gap, 0.5);
  EXPECT_EQ(references.get(0, 1,
                           [] {
                             return Reference{{}, 0, "failed"};
                           })
                .why,
            "failed");
  EXPECT_EQ(references.get(0, 1, compute).why, "failed");
}

TEST(HardCaseGrid, HasEveryCellOnce) {
  CommandLine line;
  line.quick = true;
  const Grid grid = hard_grid(line, Settings(line, hard_case_settings()));
  std::set<std::string> cells, cases;
  for (const Cell& cell : grid.cells) {
    EXPECT_TRUE(cells.insert(describe(cell.identity())).second);
    EXPECT_LT(cell.reference, grid.references);
    cases.insert(std::string(cell.attempt.hard->name));
  }
  EXPECT_EQ(cases.size(), hard_case_catalogue().size());
  // Four integrators at two steps on each model and system of particles, bdf2 at one and
  // tr_bdf2 at one tolerance.
  EXPECT_EQ(grid.cells.size(), 10 * grid.references);
  line.set = {{"position_tol_rel", "1e-3"}};
  const Grid chosen = hard_grid(line, Settings(line, hard_case_settings()));
  EXPECT_EQ(chosen.cells.size(), grid.references);
  for (const Cell& cell : chosen.cells) {
    EXPECT_EQ(cell.attempt.pace, (Pace{longest, 1e-3}));
    EXPECT_EQ(cell.identity().number("position_tol_rel"), 1e-3);
    EXPECT_EQ(cell.attempt.options.tolerance, 0);  // that of the reference
  }
  line.set = {{"case", "straihgt"}};
  EXPECT_THROW(static_cast<void>(hard_grid(line, Settings(line, hard_case_settings()))),
               InputError);
}

using State = Verdicts::State;

Row claimed(std::string_view hard, std::string_view passed, std::string_view outcome) {
  Row row;
  row.set("case", hard).set("model", "super_helix").set("variant", "jacobian=exact");
  row.set("integrator", "backward_euler").set("dt_s", 1.0 / 30);
  return row.set("passed", passed).set("outcome", outcome).set("why", "broke");
}

/// What is said of the case, or of all cells.
Verdicts::Verdict judged(const Row& row, std::string_view of) {
  Verdicts verdicts;
  check_hard_cases({row}, verdicts);
  // One of each case, three about tolerances, and one of exact contact.
  EXPECT_EQ(
      std::ranges::count(verdicts.all(), State::not_judged, &Verdicts::Verdict::state),
      static_cast<std::ptrdiff_t>(hard_case_catalogue().size()) - 1 + 4);
  for (const auto& verdict : verdicts.all()) {
    if (verdict.claim.starts_with(of)) return verdict;
  }
  return {"none", false, 0, State::not_judged, ""};
}

TEST(HardCaseClaims, FailOnAWrongTable) {
  const auto of = [](std::string_view passed, std::string_view outcome) {
    return judged(claimed("straight", passed, outcome), "straight").state;
  };
  EXPECT_EQ(of("true", "stable"), State::held);
  EXPECT_EQ(of("false", "unstable"), State::broken);
  EXPECT_EQ(of("false", "refused"), State::not_judged);  // no claim at all
  EXPECT_EQ(judged(claimed("straight", "true", ""), "every cell").state, State::broken);
}

Row by_tolerance(std::string_view hard, std::string_view outcome, double error) {
  Row row;
  row.set("case", hard).set("model", "super_helix").set("variant", "jacobian=exact");
  row.set("integrator", "tr_bdf2").set("measure", 0.5).set("limit", 1.0);
  Pace{longest, 1e-3}.identify(row);
  row.set("outcome", outcome).set("passed", outcome.starts_with("stable"));
  if (!std::isnan(error)) row.set("error_rel", error);
  return row;
}

State state_of(const Row& row, std::string_view claim) {
  Verdicts verdicts;
  check_hard_cases({row}, verdicts);
  for (const auto& verdict : verdicts.all()) {
    if (verdict.claim.starts_with(claim)) return verdict.state;
  }
  throw std::runtime_error("no claim " + std::string(claim));
}

TEST(HardCaseClaims, NothingPassesByToleranceThatIsWrong) {
  const std::string_view claim = "no adaptive run passes";
  EXPECT_EQ(state_of(by_tolerance("straight", "stable and accurate", 0.01), claim),
            State::held);
  EXPECT_EQ(state_of(by_tolerance("straight", "stable", 0.06), claim), State::broken);
  EXPECT_EQ(state_of(by_tolerance("straight", "stable", std::nan("")), claim),
            State::held);  // there is no reference
  EXPECT_EQ(state_of(by_tolerance("turns_6_per_element", "stable", 0.06), claim),
            State::held);  // three elements for what a rod of 36 does
  EXPECT_EQ(state_of(by_tolerance("million_steps", "stable", 0.3), claim), State::held);
  EXPECT_EQ(state_of(by_tolerance("straight", "unstable", 0.06), claim),
            State::not_judged);
  Row beyond = by_tolerance("straight", "stable and accurate", 0.01);
  beyond.set("measure", 2.0);
  EXPECT_EQ(state_of(beyond, claim), State::broken);
  beyond.set("measure", "nan");
  EXPECT_EQ(state_of(beyond, claim), State::broken);
}

TEST(HardCaseClaims, LongCurlAndConeAreAccurateByTolerance) {
  for (const std::string_view hard : {"long_curl", "cone"}) {
    const std::string claim =
        std::string(hard) + ": super_helix, exact Jacobian, tr_bdf2 is accurate";
    const double none = std::nan("");
    EXPECT_EQ(state_of(by_tolerance(hard, "stable and accurate", 1e-3), claim),
              State::held);
    EXPECT_EQ(state_of(by_tolerance(hard, "stable", 0.2), claim), State::broken);
    EXPECT_EQ(state_of(by_tolerance(hard, "unstable", none), claim), State::broken);
    EXPECT_EQ(state_of(by_tolerance(hard, "stable", none), claim),
              State::not_judged);  // there is no reference
    EXPECT_EQ(state_of(by_tolerance(hard, "not finished", none), claim),
              State::not_judged);
  }
}

// Of each of so many steps: one that falls by the regularised law and holds by impulses.
std::vector<Row> risen(int count) {
  std::vector<Row> rows;
  for (int i = 1; i <= count; ++i) {
    rows.push_back(claimed("coil_contact", "false", "unstable").set("dt_s", 1e-3 * i));
    rows.push_back(claimed("coil_impulse", "true", "stable").set("dt_s", 1e-3 * i));
  }
  return rows;
}

TEST(HardCaseClaims, ExactContactHoldsWhatFellOnlyForTheSameRun) {
  const auto of = [](const std::vector<Row>& rows) {
    Verdicts verdicts;
    check_hard_cases(rows, verdicts);
    return verdicts.all().back();
  };
  EXPECT_EQ(of(risen(15)).state, State::held);
  EXPECT_EQ(of(risen(15)).value, 15);
  EXPECT_EQ(of(risen(14)).state, State::broken);
  std::vector<Row> other = risen(15);
  other.back().set("integrator", "linearly_implicit_euler");
  EXPECT_EQ(of(other).state, State::broken);
  other = risen(15);
  other.front().set("outcome", "stable");  // did not fall
  EXPECT_EQ(of(other).state, State::broken);
  other = risen(15);
  other[1].set("passed", "false");  // fell again
  EXPECT_EQ(of(other).state, State::broken);
  EXPECT_EQ(of({claimed("straight", "true", "stable")}).state, State::not_judged);
}

// What is known to fail is no alarm as long as it fails as it is known to.
TEST(HardCaseClaims, KnownLimitsAlarmWhenTheyChange) {
  Row known = claimed("million_steps", "false", "unstable").set("measure", 0.2085);
  EXPECT_EQ(judged(known, "million_steps").state, State::known_limit);
  EXPECT_FALSE(judged(known, "million_steps").alarm());
  EXPECT_NE(judged(known, "million_steps").reason, "");
  known.set("measure", 0.5);
  EXPECT_EQ(judged(known, "million_steps").state, State::changed);
  known.set("measure", "");
  EXPECT_TRUE(judged(known, "million_steps").alarm());
  const Row held = claimed("million_steps", "true", "stable").set("measure", 0.009);
  EXPECT_TRUE(judged(held, "million_steps").alarm());
  EXPECT_NE(judged(held, "million_steps").reason.find("take it off"), std::string::npos);
}

}  // namespace tress::test_hard_cases
