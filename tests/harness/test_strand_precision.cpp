#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "experiments/numerics/tip_track.h"
#include "experiments/other_simulators/simulator.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/work_precision/work_precision.h"
#include "models/strand/strand_parameters.h"
#include "simulation/run/simulation.h"

namespace tress::test_strand_precision {

using namespace experiments;
using namespace experiments::other_simulators;
using namespace experiments::work_precision;

// ---- the track of a tip -----------------------------------------------------------

/// A unit mass under a constant force; its "strand" is two points, the root at 0.
class Thrown final : public System, private MaterialPoints {
 public:
  double fails_after = std::numeric_limits<double>::infinity();  // s

  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override {
    q[0] = 1;
    v[0] = 2;
  }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double t, In, In, In a, Out r) noexcept override {
    r[0] = a[0] + 3;
    return t > fails_after ? Status::fatal : Status::ok;
  }
  Status linearize(double, In, In, In, Weights) noexcept override { return Status::ok; }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0];
    return Status::ok;
  }
  MaterialPoints* material_points() override { return this; }

 private:
  int count() const override { return 2; }
  void positions(double t, In q, Out x) override {
    std::ranges::fill(x, 0.0);
    x[3] = q[0];
    x[4] = t;
  }
  void velocities(double, In, In v, Out u) override {
    std::ranges::fill(u, 0.0);
    u[3] = v[0];
    u[4] = 1;
  }
};

TEST(TipTrack, SamplesLieBetweenSteps) {
  Thrown thrown;
  Options options;
  options.step = 0.3;  // samples every 0.1 s
  const TipRun run = run_tip("implicit_midpoint", thrown, options, 1.2, 12);
  ASSERT_EQ(run.status, Status::ok);
  ASSERT_EQ(run.tip.size(), 36u);
  EXPECT_EQ(run.stats.steps, 4);
  for (std::size_t k = 1; k <= 12; ++k) {
    const double t = 0.1 * static_cast<double>(k);
    // The rule is exact for a constant force, and a cubic holds a parabola: rounding.
    EXPECT_NEAR(run.tip[3 * k - 3], 1 + 2 * t - 1.5 * t * t, 1e-13);
    EXPECT_NEAR(run.tip[3 * k - 2], t, 1e-13);
  }
}

TEST(TipTrack, RepeatsStartAfresh) {
  Thrown thrown;
  Options options;
  options.step = 0.01;
  const TipRun once = run_tip("implicit_midpoint", thrown, options, 1, 5);
  const TipRun timed = run_tip("implicit_midpoint", thrown, options, 1, 5, 3);
  EXPECT_EQ(once.tip, timed.tip);
  EXPECT_EQ(timed.stats.steps, 100);
  EXPECT_EQ(once.wall_s, 0);
  EXPECT_GT(timed.wall_s, 0);
}

TEST(TipTrack, AFailedRunLacksSamples) {
  Thrown thrown;
  thrown.fails_after = 0.52;  // between the midpoints of the steps from 6/13 and 7/13 s
  Options options;
  options.step = 1. / 13;
  const TipRun run = run_tip("implicit_midpoint", thrown, options, 1, 10);
  EXPECT_NE(run.status, Status::ok);
  EXPECT_FALSE(run.failure.empty());
  EXPECT_EQ(run.tip.size(), 15u);
}

TEST(TipError, IsTheRootMeanSquareOverTheLength) {
  const std::vector<double> reference(6);
  // Distances 5 and 0: sqrt(25/2) over 10.
  EXPECT_DOUBLE_EQ(tip_error(std::vector<double>{3, 0, 4, 0, 0, 0}, reference, 10),
                   std::sqrt(12.5) / 10);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(tip_error(std::vector<double>(3), reference, 10), infinity);
  EXPECT_EQ(tip_error(std::vector<double>(6, std::nan("")), reference, 10), infinity);
}

// ---- references -------------------------------------------------------------------

TEST(TipError, LargestIsThatOfTheWorstSampleAndInfiniteWhereOneIsMissing) {
  const std::vector<double> reference(6, 0.0);
  const std::vector<double> tip{0.3, 0, 0.4, 0, 0.1, 0};
  EXPECT_DOUBLE_EQ(largest_tip_error(tip, reference, 2), 0.25);
  EXPECT_EQ(largest_tip_error({tip.data(), 3}, reference, 2),
            std::numeric_limits<double>::infinity());
}

TEST(Extrapolated, RemovesWhatFallsWithTheSquare) {
  const auto answer = [](double h) { return std::vector<double>{7 + 5 * h * h, -h * h}; };
  const auto limit = extrapolated(answer(0.3), answer(0.1), 3);
  EXPECT_NEAR(limit[0], 7, 1e-14);
  EXPECT_NEAR(limit[1], 0, 1e-14);
}

std::unique_ptr<System> swinging(std::string_view model, int elements) {
  ModelSettings settings = find_strand_scene("swing").settings;
  settings.emplace_back("elements", std::to_string(elements));
  settings.emplace_back("modes", "bend");
  settings.emplace_back("jacobian", "elastic");
  return make_model(model, settings);
}

constexpr double length = 0.2;

TEST(ConvergedModel, IsWhatStepsTendTo) {
  const TipSampling sampling{0.3, 15, length};
  const TipReference reference = converged_model(swinging, "super_helix", 5, sampling);
  // Local errors of 1e-5 of 15 to 20 times a curvature of 1/L make far less of the tip.
  EXPECT_LE(reference.gap, 1e-5);
  const auto error = [&](double step) {
    const auto system = swinging("super_helix", 5);
    Options options;
    options.step = step;
    const TipRun run =
        run_tip("implicit_midpoint", *system, options, sampling.t_end, sampling.samples);
    return tip_error(run.tip, reference.tip, length);
  };
  // Order 2, with errors well above the gap.
  const double coarse = error(2e-3), fine = error(1e-3);
  EXPECT_GT(fine, 10 * reference.gap);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
}

TEST(ConvergedRod, IsWhatElementsTendTo) {
  const TipSampling sampling{0.1, 5, length};
  const TipReference rod = converged_rod(swinging, sampling);
  const auto error = [&](int elements) {
    const auto system = swinging("super_helix", elements);
    Options options;
    options.step = 2.5e-4;
    const TipRun run =
        run_tip("implicit_midpoint", *system, options, sampling.t_end, sampling.samples);
    return tip_error(run.tip, rod.tip, length);
  };
  const double coarse = error(10), fine = error(20);
  EXPECT_GT(fine, 10 * rod.gap);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3);
}

TEST(ConvergedModel, ThrowsWhenItsRunFails) {
  const MakeStrand make = [](std::string_view, int) {
    auto thrown = std::make_unique<Thrown>();
    thrown->fails_after = 0.1;
    return thrown;
  };
  EXPECT_THROW((void)converged_model(make, "thrown", 1, {1, 10, 1}), std::runtime_error);
}

// ---- the scene --------------------------------------------------------------------

TEST(SwingScene, IsTheOneOfThePeers) {
  using other_simulators::Swing;
  const ModelEntry& model = find_model("super_helix");
  Parameters p(setup_parameters(model), "super_helix");
  for (const auto& [key, value] : find_strand_scene("swing").settings) p.set(key, value);
  const Strand made = strand(p);
  // OtherSimulators count in mm, mg and s.
  EXPECT_NEAR(made.length(), 1e-3 * Swing::length, 1e-15);
  EXPECT_NEAR(made.mass(), 1e-6 * Swing{1}.mass(), 1e-20);
  const CrossSection& section = made.segments.front().section;
  EXPECT_DOUBLE_EQ(section.a1, 1e-3 * Swing::radius);
  EXPECT_DOUBLE_EQ(section.a2, 1e-3 * Swing::radius);
  const Swing one{1};  // EI / l = stiffness of an inner hinge, mg mm^2/s^2
  EXPECT_NEAR(made.material.youngs_modulus * section.inertia1() / made.length(),
              1e-12 * one.stiffness(1), 1e-20);
  EXPECT_EQ(made.material.internal_friction, 0);
  for (const Segment& segment : made.segments) {
    EXPECT_EQ(dot(segment.natural, segment.natural), 0);
    EXPECT_EQ(dot(segment.initial, segment.initial), 0);
  }
  for (const double t : {0.0, 0.13, 0.77, 1.5}) {
    const RootPose root = made.root.at(t);
    EXPECT_NEAR(root.x.y, 1e-3 * Swing::clamp(t), 1e-15);
    EXPECT_EQ(root.x.x, 0);
    EXPECT_EQ(root.x.z, 0);
    EXPECT_EQ(root.frame.e0.x, 1);
    // What the other simulators' links feel at rest seen from the clamp, m/s^2.
    const Vec felt = 1e-3 * Swing::gravity(t);
    const double damping = p.number("mass_damping_per_s");
    EXPECT_NEAR(-root.a.y - damping * root.v.y, felt.y, 1e-12);
    EXPECT_NEAR(-p.number("gravity_m_s2"), felt.z, 1e-12);
  }
  EXPECT_EQ(find_strand_scene("swing").t_end, Swing::t_end);
}

// ---- rows -------------------------------------------------------------------------

/// The swing's, with what else was chosen.
CommandLine of_swing() {
  CommandLine line;
  line.set = {{"scene", "swing"}};
  return line;
}

std::vector<StrandCase> cases(const CommandLine& line) {
  return strand_cases(line, Settings(line, row_settings()));
}

TEST(StrandGrid, IdentitiesDifferAndIntegratorsAreThere) {
  const std::vector<StrandCase> all = cases(of_swing());
  std::set<std::string> identities;
  std::set<std::string_view> integrators;
  for (const StrandCase& c : all) {
    EXPECT_TRUE(identities.insert(describe(c.identity())).second)
        << describe(c.identity());
    integrators.insert(c.integrator);
    if (c.error_kind == "time") {
      EXPECT_EQ(c.elements, simulator_elements);
      EXPECT_EQ(c.grading, 1);
    }
  }
  for (const std::string_view id :
       {"implicit_midpoint", "linearly_implicit_midpoint", "generalized_alpha", "newmark",
        "bdf2", "ida", "cvode_bdf", "arkode_dirk", "linearly_implicit_euler", "rk4"}) {
    EXPECT_TRUE(integrators.contains(id)) << id;
  }
}

TEST(StrandGrid, FollowsTheCommandLine) {
  CommandLine line;
  line.integrators = {"implicit_midpoint"};
  line.models = {"articulated_chain"};
  line.elements = {9};
  line.set = {{"scene", "swing"},
              {"error", "total"},
              {"newton_tolerance", "1e-3"},
              {"refresh", "when_slow"}};
  const std::vector<StrandCase> chosen = cases(line);
  ASSERT_FALSE(chosen.empty());
  for (const StrandCase& c : chosen) {
    EXPECT_EQ(c.integrator, "implicit_midpoint");
    EXPECT_EQ(c.model->id, "articulated_chain");
    EXPECT_EQ(c.elements, 9);
    EXPECT_EQ(c.error_kind, "total");
    EXPECT_EQ(c.options.newton_tolerance, 1e-3);
    EXPECT_EQ(c.options.refresh, Refresh::when_slow);
  }
}

TEST(StrandGrid, ParametersAreThoseOfTheRow) {
  CommandLine line;
  line.integrators = {"bdf2"};
  line.set = {{"scene", "swing"}, {"modes", "bend_twist"}, {"quadrature", "8"}};
  const Settings settings(line, row_settings());
  for (const StrandCase& c : strand_cases(line, settings)) {
    const Parameters p = c.parameters(settings);
    EXPECT_EQ(p.word("modes"), "bend_twist");
    EXPECT_EQ(p.word("jacobian"), c.jacobian);
    EXPECT_EQ(p.whole("elements"), c.elements);
    EXPECT_EQ(p.whole("quadrature"), 8);
    EXPECT_EQ(p.word("motion"), "swing");
  }
}

TEST(StrandGrid, ReleasesEveryStrandModelForItsTotalErrorAndByTolerance) {
  CommandLine line;
  line.set = {{"scene", "strand_release"}};
  std::set<std::string_view> models, controlled;
  for (const StrandCase& c : cases(line)) {
    EXPECT_EQ(c.strand->name, "strand_release");
    if (c.error_kind == "total") models.insert(c.model->id);
    if (c.options.tolerance == 0) continue;
    EXPECT_EQ(c.error_kind, "time");
    controlled.insert(c.model->id);
  }
  EXPECT_EQ(models.size(), strand_models().size());
  EXPECT_EQ(controlled.size(), strand_models().size());
}

TEST(StrandGrid, BothStrandsHaveEveryIntegratorWithItsFirstModel) {
  for (const char* const scene : {"swing", "strand_release"}) {
    CommandLine line;
    line.set = {{"scene", scene}, {"error", "time"}};
    std::map<std::string_view, std::set<std::string_view>> models;
    for (const StrandCase& c : cases(line)) {
      if (c.options.tolerance == 0) models[c.integrator].insert(c.model->id);
    }
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      EXPECT_TRUE(models.contains(entry.id)) << scene << ": " << entry.id;
    }
    EXPECT_THAT(models["guarded"], testing::ElementsAre("super_helix"));
    EXPECT_THAT(models["stable_cosserat_rods"], testing::ElementsAre("corde"));
    EXPECT_THAT(models["rattle"], testing::ElementsAre("inextensible_strand"));
    EXPECT_THAT(models["xpbd"], testing::ElementsAre("mass_spring"));
  }
}

Row run(std::string_view kind, int elements, double error, double wall,
        std::string_view modes = "bend") {
  Row row;
  row.set("scene", "swing").set("error_kind", kind);
  row.set("model", "super_helix").set("modes", modes);
  row.set("integrator", "implicit_midpoint").set("elements", elements);
  row.set("error_rel", error).set("wall_s", wall);
  return row;
}

TEST(Pareto, IsWhatNothingBeatsInBoth) {
  std::vector<Row> rows{run("time", 20, 0.01, 1), run("time", 20, 0.02, 2),
                        run("time", 20, 0.005, 3), run("time", 5, 0.02, 2),
                        run("time", 20, 0.01, 0.5)};
  rows.back().failed("diverged", "not counted");
  add_pareto(rows, "error_rel",
             [](const Row& row) { return std::string(row.text("elements")); });
  EXPECT_EQ(rows[0].text("pareto"), "true");
  EXPECT_EQ(rows[1].text("pareto"), "false");
  EXPECT_EQ(rows[2].text("pareto"), "true");
  EXPECT_EQ(rows[3].text("pareto"), "true");
  EXPECT_EQ(rows[4].text("pareto"), "");
}

using State = Verdicts::State;

struct Judged {
  std::vector<Row> rows;

  /// Of the claim, or figure, that begins so.
  Verdicts::Verdict of(std::string_view begin) const {
    Verdicts all;
    check_swing_claims(rows, all);
    for (const auto& verdict : all.all()) {
      if (verdict.claim.starts_with(begin)) return verdict;
    }
    return {"none", false, 0, State::broken, "no such claim"};
  }
};

TEST(SwingClaims, TakeTheFastestRunThatIsAccurateEnough) {
  const Judged swing{{run("time", 20, 0.009, 0.015), run("time", 20, 0.02, 0.001),
                      run("time", 20, 0.0009, 0.06), run("time", 5, 0.0001, 0.001)}};
  EXPECT_EQ(swing.of("some run has 1 % time error").state, State::held);
  EXPECT_EQ(swing.of("some run has 0.1 % time error").value, 0.0009);
  EXPECT_EQ(swing.of("seconds to 1 % time error").value, 0.015);
  EXPECT_EQ(swing.of("seconds to 0.1 % time error").state, State::figure);
  EXPECT_EQ(swing.of("some run has 1 % total error").state, State::not_judged);
}

TEST(SwingClaims, AreOfTheSwingAlone) {
  Judged other{{run("total", 9, 0.001, 0.001)}};
  EXPECT_EQ(other.of("some run has 1 % total error").state, State::held);
  other.rows[0].set("scene", "strand_release");
  EXPECT_EQ(other.of("some run has 1 % total error").state, State::not_judged);
}

TEST(SwingClaims, DoNotHoldWhereNothingIsAccurateEnough) {
  Judged swing{{run("total", 9, 0.02, 0.001)}};
  EXPECT_EQ(swing.of("some run has 1 % total error").state, State::broken);
  EXPECT_EQ(swing.of("some run has 1 % total error").value, 0.02);
  // Of a method that need not be.
  swing.rows[0].set("integrator", "backward_euler");
  EXPECT_EQ(swing.of("some run has 1 % total error").state, State::not_judged);
}

TEST(SwingClaims, CompareConvergedRunsWithAndWithoutTwist) {
  const auto twist = [](double error, const char* tolerance) {
    std::vector<Row> rows{run("time", 20, 0.005, 1),
                          run("time", 20, error, 1, "bend_twist")};
    for (Row& row : rows) row.set("dt_s", 1e-3).set("newton_tolerance", tolerance);
    return Judged{rows}.of("converged steps");
  };
  EXPECT_TRUE(twist(0.0051, "1e-10").held);
  EXPECT_FALSE(twist(0.0056, "1e-10").held);
  EXPECT_NEAR(twist(0.0056, "1e-10").value, 0.12, 1e-12);
  EXPECT_EQ(twist(0.0056, "0.3").state, State::not_judged);
}

TEST(SwingClaims, ReferencesMustAgree) {
  Judged swing{{run("total", 9, 0.02, 0.001), run("total", 5, 0.02, 0.001)}};
  swing.rows[0].set("reference_gap", 2e-5);
  EXPECT_TRUE(swing.of("rod:").held);
  swing.rows[1].set("reference_gap", 2e-4);
  EXPECT_EQ(swing.of("rod:").state, State::broken);
  EXPECT_EQ(swing.of("rod:").value, 2e-4);
  EXPECT_EQ(swing.of("time:").state, State::not_judged);
}

}  // namespace tress::test_strand_precision
