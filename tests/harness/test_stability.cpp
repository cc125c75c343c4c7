#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "contract/input_error.h"
#include "experiments/numerics/stability.h"
#include "tests/support/small_systems.h"

namespace tress::test_stability {

using namespace experiments;

using testing_support::AnglePendulum;

// ---- the judge --------------------------------------------------------------------

struct SpringData {
  double stiffness = 100, force = 0, q0 = 1, v0 = 0;
};

/// q'' + stiffness q = force of a unit mass, seen as a body between a root that travels
/// at `root_speed` and a tip at the root plus (q, 0, 0).
class Spring final : public System,
                     private ExplicitForm,
                     private Energetics,
                     private MaterialPoints {
 public:
  explicit Spring(const SpringData& data) : data_(data) {}

  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override {
    q[0] = data_.q0;
    v[0] = data_.v0;
  }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double, In q, In, In a, Out r) noexcept override {
    r[0] = a[0] + data_.stiffness * q[0] - data_.force;
    return Status::ok;
  }
  Status linearize(double, In, In, In, Weights w) noexcept override {
    s_ = w.acc + w.pos * data_.stiffness;
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / s_;
    return Status::ok;
  }
  ExplicitForm* explicit_form() override { return this; }
  Energetics* energetics() override { return this; }
  MaterialPoints* material_points() override { return this; }

 private:
  Status acceleration(double, In q, In, Out a) noexcept override {
    a[0] = data_.force - data_.stiffness * q[0];
    return Status::ok;
  }
  Energy energy(double, In q, In v) override {
    return {v[0] * v[0] / 2, data_.stiffness * q[0] * q[0] / 2 - data_.force * q[0]};
  }
  double power(double, In, In) override { return 0; }
  int count() const override { return 2; }
  void positions(double t, In q, Out x) override {
    const double root = root_speed * t;
    std::ranges::copy(std::array{0.0, root, 0.0, q[0], root, 0.0}, x.begin());
  }
  void velocities(double, In, In v, Out u) override {
    std::ranges::copy(std::array{0.0, root_speed, 0.0, v[0], root_speed, 0.0}, u.begin());
  }
  static constexpr double root_speed = 3;
  SpringData data_;
  double s_ = 1;
};

Options step_of(double h) {
  Options options;
  options.step = h;
  return options;
}

StepLimit limit_of(std::string_view integrator, const SpringData& data, double t_end,
                   double energy, const StepSearch& search) {
  Spring spring(data);
  return find_step_limit(search, [&](double dt) {
    return judge_run(integrator, spring, step_of(dt), initial_state(spring), t_end,
                     {.energy = energy})
        ->broken;
  });
}

constexpr double omega = 10;        // rad/s, of the spring as it is by default
constexpr double full_energy = 50;  // J, of that spring
constexpr StepSearch fine{.coarsest = 1, .finest = 1e-4, .resolution = 1.002};

// From rest at q = 1 the method's own invariant, v^2 + (1 - theta) omega^2 q^2 with theta
// = (omega h / 2)^2, keeps E at or below its start for theta < 1. Beyond, q grows as
// cosh(2 n sqrt(2 e)) with omega h = 2 (1 + e): 1 % of energy after n = 500 steps takes
// e = 5e-9. So the limit is 2 / omega to 1e-8.
TEST(StabilityLimit, OfVelocityVerletOnASpringIsTwoOverOmega) {
  const StepLimit limit = limit_of("velocity_verlet", {}, 100, 0.01 * full_energy, fine);
  EXPECT_LE(limit.stable, 2 / omega * (1 + 1e-8));
  EXPECT_GE(limit.unstable, 2 / omega * (1 - 1e-8));
  EXPECT_LE(limit.unstable, fine.resolution * limit.stable);
  EXPECT_EQ(limit.limited_by, Broken::energy);
  EXPECT_TRUE(limit.complete);
}

// From q = 0 the same invariant lets E rise by theta / (1 - theta) where the step falls
// on the turning point: 1 % at theta = 0.01 / 1.01. Steps are 0.2 rad apart, so that at
// least one falls within 0.1 rad of it: sin^2 >= 0.99, half of that in h.
TEST(StabilityLimit, CountsOnePercentOfEnergyAsUnstable) {
  const StepLimit limit =
      limit_of("velocity_verlet", {.q0 = 0, .v0 = omega}, 100, 0.01 * full_energy, fine);
  const double predicted = 2 / omega * std::sqrt(0.01 / 1.01);
  EXPECT_GE(limit.unstable, predicted);
  EXPECT_LE(limit.stable, 1.005 * predicted);
}

// Each step multiplies E by 1 + (omega h)^2, t_end / h of them, at most one more: h =
// 1e-4 of 1 s. The scan is fine enough not to land on an end of its own.
TEST(StabilityLimit, OfExplicitEulerIsWhereItsGrowthReachesOnePercent) {
  const StepLimit limit = limit_of("explicit_euler", {}, 1, 0.01 * full_energy,
                                   {.coarsest = 0.1, .finest = 1e-6, .resolution = 1.01});
  const auto growth = [](double h) {
    return std::pow(1 + omega * omega * h * h, std::ceil(1 / h));
  };
  EXPECT_LE(growth(limit.stable), 1.01);
  EXPECT_GT(growth(limit.unstable), 1.01);
}

// A-stable and dissipative: no step is too long for a linear spring.
TEST(StabilityLimit, OfBackwardEulerOnASpringIsTheCap) {
  const StepLimit limit = limit_of("backward_euler", {}, 10, 0.01 * full_energy, fine);
  EXPECT_EQ(limit.stable, fine.coarsest);
  EXPECT_TRUE(std::isnan(limit.unstable));
  EXPECT_EQ(limit.limited_by, Broken::nothing);
}

// From rest under force 2 and no spring: q = t^2, v = 2 t, which rk4 follows exactly.
Spring thrown() { return Spring({.stiffness = 0, .force = 2, .q0 = 0}); }

TEST(StabilityJudge, EndsWhereTheTipIsOutOfReach) {
  Spring spring = thrown();
  const auto run =
      judge_run("rk4", spring, step_of(0.125), initial_state(spring), 10, {.reach = 1.1});
  EXPECT_EQ(run->broken, Broken::reach);
  EXPECT_EQ(run->t, 1.125);  // 1 m at 1 s was in reach
  EXPECT_DOUBLE_EQ(run->reach, 1.125 * 1.125);
}

// The root travels at 3 m/s; only the speed relative to it counts.
TEST(StabilityJudge, EndsWhereTheTipIsTooFast) {
  Spring spring = thrown();
  const auto run =
      judge_run("rk4", spring, step_of(0.125), initial_state(spring), 10, {.speed = 1.1});
  EXPECT_EQ(run->broken, Broken::speed);
  EXPECT_EQ(run->t, 0.625);
  EXPECT_DOUBLE_EQ(run->speed, 1.25);
}

TEST(StabilityJudge, WithinItsBoundsARunIsStable) {
  Spring spring({});
  const auto run = judge_run("rk4", spring, step_of(0.01), initial_state(spring), 1,
                             {.energy = 0.5, .reach = 1.01, .speed = 1.01 * omega});
  EXPECT_TRUE(run->stable());
  EXPECT_EQ(run->stats.steps, 100);
  // rk4 at omega h = 0.1 loses (omega h)^6 / 72 of its amplitude per step, and the
  // fastest step is at most 0.05 rad off: cos >= 0.998.
  EXPECT_NEAR(run->speed, omega, 2e-3 * omega);
}

TEST(StabilityJudge, TakesTheStepAskedForEvenIfTheRunGetsLonger) {
  Spring spring({});
  const auto run = judge_run("rk4", spring, step_of(0.3), initial_state(spring), 1, {});
  EXPECT_DOUBLE_EQ(run->t, 1.2);
  EXPECT_EQ(run->stats.steps, 4);
}

TEST(StabilityJudge, ValuesThatAreNotFiniteAreUnstable) {
  Spring spring({.stiffness = -1e8});  // grows by 1e3 per step and more
  EXPECT_EQ(
      judge_run("explicit_euler", spring, step_of(0.1), initial_state(spring), 1e3, {})
          ->broken,
      Broken::not_finite);
  Spring overflowing({.q0 = 1e200});  // finite, its energy is not
  EXPECT_EQ(judge_run("rk4", overflowing, step_of(0.1), initial_state(overflowing), 1,
                      {.energy = 1})
                ->broken,
            Broken::not_finite);
}

TEST(StabilityJudge, AStepWithoutSolutionIsUnstableAndSaysSo) {
  AnglePendulum pendulum;
  pendulum.fails_after = 0.55;
  const auto run =
      judge_run("backward_euler", pendulum, step_of(0.1), initial_state(pendulum), 1, {});
  EXPECT_EQ(run->broken, Broken::no_solution);
  EXPECT_DOUBLE_EQ(run->t, 0.5);
  EXPECT_FALSE(run->failure.empty());
}

TEST(StabilityJudge, RefusesASystemThatCannotBeJudged) {
  AnglePendulum pendulum;
  EXPECT_THROW((void)judge_run("rk4", pendulum, step_of(0.1), initial_state(pendulum), 1,
                               {.energy = 1}),
               InputError);
  EXPECT_THROW((void)judge_run("rk4", pendulum, step_of(0.1), initial_state(pendulum), 1,
                               {.speed = 1}),
               InputError);
}

// A step of rk4 on the spring's one coordinate: four accelerations, their solves as the
// system has them, and the step itself.
TEST(StabilityJudge, GivesNoVerdictOnceTheWorkIsUsedUp) {
  Spring spring({});
  const State start = initial_state(spring);
  Options options = step_of(0.1);
  const auto whole = judge_run("rk4", spring, options, start, 100, {});
  ASSERT_TRUE(whole && whole->stable());
  const double work = total_work(whole->stats, 1);
  EXPECT_GE(work, 1000 * (4 + 1) * 11);
  options.max_work = 0.5 * work;
  EXPECT_FALSE(judge_run("rk4", spring, options, start, 100, {}));
  options.max_work = 2 * work;
  EXPECT_TRUE(judge_run("rk4", spring, options, start, 100, {}));

  StabilityRuns runs("rk4", spring, step_of(0.1), start, 100, {}, 1.5 * work);
  EXPECT_TRUE(runs.judge(0.1));
  EXPECT_FALSE(runs.judge(0.1));
  EXPECT_FALSE(runs.judge(1));
}

// ---- the search -------------------------------------------------------------------

/// A predicate with the unstable steps in given intervals, and the steps it was asked
/// for.
struct Synthetic {
  struct Interval {
    double from, to;
  };
  std::vector<Interval> unstable;
  std::vector<double> asked = {};
  std::size_t patience = std::numeric_limits<std::size_t>::max();

  std::optional<Broken> operator()(double dt) {
    if (asked.size() == patience) return {};
    asked.push_back(dt);
    for (const Interval& i : unstable) {
      if (i.from < dt && dt <= i.to) return Broken::speed;
    }
    return Broken::nothing;
  }
};

StepLimit search(Synthetic& steps, const StepSearch& how = {}) {
  return find_step_limit(how, [&steps](double dt) { return steps(dt); });
}

TEST(StepSearch, BracketsTheLimitWithinTheResolution) {
  for (const double edge : {3.3e-2, 7.1e-4, 2.2e-6}) {
    Synthetic steps{{{edge, 1}}};
    const StepLimit limit = search(steps);
    EXPECT_LE(limit.stable, edge);
    EXPECT_GT(limit.unstable, edge);
    EXPECT_LE(limit.unstable, 1.05 * limit.stable);
    EXPECT_EQ(limit.limited_by, Broken::speed);
    EXPECT_TRUE(std::isnan(limit.stable_above));
    EXPECT_EQ(limit.runs, static_cast<int>(steps.asked.size()));
  }
}

TEST(StepSearch, GoesFromCoarseToFineAndNoFurtherThanItsDepth) {
  Synthetic steps{{{4e-2, 1}}};
  StepSearch how;
  how.resolution = 2;  // the scan alone
  const StepLimit limit = search(steps, how);
  EXPECT_TRUE(std::ranges::is_sorted(steps.asked, std::greater<>()));
  EXPECT_EQ(steps.asked.front(), 0.1);
  EXPECT_EQ(limit.finest, steps.asked.back());
  EXPECT_LE(how.depth * steps.asked.back(), limit.stable);
  EXPECT_GT(how.ratio * how.depth * steps.asked.back(), limit.stable);
}

// Given up while it looks deeper, a search has its limit already.
TEST(StepSearch, BracketsTheLimitBeforeItLooksDeeper) {
  Synthetic steps{.unstable = {{4e-2, 1}}, .patience = 8};
  const StepLimit limit = search(steps);
  EXPECT_TRUE(limit.resolved);
  EXPECT_FALSE(limit.complete);
  EXPECT_LE(limit.stable, 4e-2);
  EXPECT_GT(limit.unstable, 4e-2);
  Synthetic patient{{{4e-2, 1}}};
  EXPECT_TRUE(search(patient).complete);
}

// What is stable above an unstable step does not count, however much of it there is.
TEST(StepSearch, AnUnstableIslandBelowStableStepsIsTheLimit) {
  Synthetic steps{{{2e-3, 6e-3}, {5e-2, 1}}};
  const StepLimit limit = search(steps);
  EXPECT_LE(limit.stable, 2e-3);
  EXPECT_GT(limit.unstable, 2e-3);
  EXPECT_LE(limit.unstable, 1.05 * limit.stable);
  EXPECT_GT(limit.stable_above, 6e-3);
  EXPECT_LE(limit.stable_above, 5e-2);
}

TEST(StepSearch, AnIslandUnderTheCapIsTheLimitToo) {
  Synthetic steps{{{6e-3, 2e-2}}};
  const StepLimit limit = search(steps);
  EXPECT_LE(limit.stable, 6e-3);
  EXPECT_EQ(limit.stable_above, 0.1);
}

// Two islands, the lower one within the depth of the upper: the scan starts to count
// anew.
TEST(StepSearch, TheLowestIslandWithinReachDecides) {
  Synthetic steps{{{1e-4, 4e-4}, {2e-3, 6e-3}}};
  EXPECT_LE(search(steps).stable, 1e-4);
}

TEST(StepSearch, EverythingStableEndsAtTheCap) {
  Synthetic steps{{}};
  const StepLimit limit = search(steps);
  EXPECT_EQ(limit.stable, 0.1);
  EXPECT_TRUE(std::isnan(limit.unstable));
  EXPECT_EQ(limit.limited_by, Broken::nothing);
}

TEST(StepSearch, NothingStableEndsAtTheFloor) {
  Synthetic steps{{{0, 1}}};
  const StepLimit limit = search(steps);
  EXPECT_TRUE(std::isnan(limit.stable));
  // 20 factors of 10^(1/4), given to eight digits.
  EXPECT_NEAR(limit.unstable, 1e-6, 1e-12);
  EXPECT_EQ(limit.runs, 21);
}

TEST(StepSearch, GivenUpItKeepsWhatItKnows) {
  Synthetic scan{.unstable = {{4e-2, 1}}, .patience = 3};
  const StepLimit scanned = search(scan);
  EXPECT_FALSE(scanned.complete);
  EXPECT_FALSE(scanned.resolved);
  EXPECT_NEAR(scanned.stable, 0.1 / std::sqrt(10.0), 1e-8);
  EXPECT_NEAR(scanned.unstable, 0.1 / std::sqrt(std::sqrt(10.0)), 1e-8);

  Synthetic none{.unstable = {}, .patience = 0};
  const StepLimit nothing = search(none);
  EXPECT_FALSE(nothing.complete);
  EXPECT_TRUE(std::isnan(nothing.stable));
  EXPECT_TRUE(std::isnan(nothing.unstable));

  Synthetic bisection{.unstable = {{4e-2, 1}}, .patience = 5};
  const StepLimit bisected = search(bisection);
  EXPECT_FALSE(bisected.complete);
  EXPECT_FALSE(bisected.resolved);
  EXPECT_LE(bisected.stable, 4e-2);
  EXPECT_GT(bisected.unstable, 4e-2);
}

}  // namespace tress::test_stability
