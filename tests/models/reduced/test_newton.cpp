#include <gtest/gtest.h>

#include <cstdio>

#include "experiments/numerics/fit.h"
#include "experiments/numerics/stability.h"
#include "experiments/problems/strand_scenes.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::test_newton {

using namespace experiments;

using namespace testing_support;

/// The equations R(a) = 0 of one backward Euler step from (q, v) at t, and Newton's
/// method on them. Sizes are those of the change of q over System::scale.
class EulerStep {
 public:
  EulerStep(System& system, double t, double h, const State& from)
      : system_(system), t_(t + h), h_(h), from_(from), q_(from.q), v_(from.v) {
    q_typ_ = v_typ_ = zeros(system);
    system.scale(q_typ_, v_typ_);
  }

  std::vector<double> residual(const std::vector<double>& a) {
    place(a);
    std::vector<double> r = a;
    EXPECT_EQ(system_.residual(t_, q_, v_, a, r), Status::ok);
    return r;
  }

  /// S(a)^-1 b
  std::vector<double> solve(const std::vector<double>& a, std::vector<double> b) {
    place(a);
    EXPECT_EQ(system_.linearize(t_, q_, v_, a, {1, h_, h_ * h_}), Status::ok);
    EXPECT_EQ(system_.solve(b, b), Status::ok);
    return b;
  }

  /// Iterates until the corrections are rounding; the last one is the solution.
  std::vector<std::vector<double>> newton(int most) {
    std::vector<std::vector<double>> iterates(1, zeros(system_));
    double correction = 1;
    while (static_cast<int>(iterates.size()) <= most && correction > 1e-13) {
      const std::vector<double>& a = iterates.back();
      const std::vector<double> step = solve(a, residual(a));
      correction = size(step);
      iterates.push_back(plus(a, -1, step));
    }
    return iterates;
  }

  double size(const std::vector<double>& a) const {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      most = std::max(most, h_ * h_ * std::abs(a[i]) / q_typ_[i]);
    }
    return most;
  }

 private:
  void place(const std::vector<double>& a) {
    v_ = plus(from_.v, h_, a);
    q_ = plus(from_.q, h_, v_);
  }

  System& system_;
  double t_, h_;
  const State& from_;
  std::vector<double> q_, v_, q_typ_, v_typ_;
};

constexpr double t_shaken = 0.231;  // s

/// In the middle of a shake of 20 elements, undamped, reached by steps of h.
State shaken(System& system, double h) {
  Options options;
  options.step = h;
  return simulate("backward_euler", system, options, initial_state(system), t_shaken)
      .state;
}

class Newton : public testing::TestWithParam<const char*> {};

TEST_P(Newton, ConvergesQuadraticallyWithTheExactTangent) {
  const auto system = make_model(GetParam(), find_strand_scene("shake").settings);
  for (const double h : {1e-3, 5e-3, 33e-3}) {
    const State from = shaken(*system, h);
    EulerStep step(*system, t_shaken, h, from);
    const auto iterates = step.newton(20);
    const std::vector<double>& solution = iterates.back();
    const std::vector<double> at_solution = step.residual(solution);
    int compared = 0;
    for (std::size_t k = 0; k + 1 < iterates.size(); ++k) {
      const std::vector<double> error = plus(iterates[k], -1, solution);
      const double e = step.size(error);
      const double next = step.size(plus(iterates[k + 1], -1, solution));
      std::printf("%s, h = %g: residual %.2e, error %.2e\n", GetParam(), h,
                  largest(step.residual(iterates[k])), e);
      // e_{k+1} = S^-1 R''(e_k, e_k)/2 and terms of third order; R'' by a difference as
      // wide as the error. Where that is a tenth of e_k at most, the third order is the
      // smaller one, so a factor of 2. Below 1e-7 rounding, 1e-15, is felt.
      std::vector<double> second = step.residual(plus(solution, 1, error));
      second = plus(second, 1, step.residual(plus(solution, -1, error)));
      second = plus(second, -2, at_solution);
      const double expected = step.size(step.solve(solution, second)) / 2;
      if (e < 1e-7 || expected > 0.1 * e) continue;
      EXPECT_GE(next, expected / 2) << "from " << e << " at h = " << h;
      EXPECT_LE(next, expected * 2) << "from " << e << " at h = " << h;
      ++compared;
    }
    EXPECT_GE(compared, 2) << "h = " << h;
  }
}

/// Slope of the error after one Newton step against the error before, from errors of
/// 1e-4, 1e-5 and 1e-6 in one random direction.
double convergence_order(System& exact, System& tested, double h) {
  const State from = shaken(exact, h);
  EulerStep solver(exact, t_shaken, h, from), step(tested, t_shaken, h, from);
  const std::vector<double> solution = solver.newton(20).back();
  const std::vector<double> direction = States(exact, 11).random(solution);
  std::vector<double> before, after;
  for (const double e : {1e-4, 1e-5, 1e-6}) {
    const std::vector<double> a = plus(solution, e / solver.size(direction), direction);
    before.push_back(e);
    after.push_back(
        solver.size(plus(plus(a, -1, step.solve(a, step.residual(a))), -1, solution)));
  }
  return log_log_slope(before, after);
}

// The next order is (constant times) the error itself: constants of up to 1e3 change the
// larger two of the three errors by 10 % and 1 %, the slope by 0.02.
TEST_P(Newton, IsOfOrder2WithTheExactTangentAnd1WithTheStiffOne) {
  const ModelSettings settings = find_strand_scene("shake").settings;
  const auto exact = make_model(GetParam(), settings);
  const auto stiff = make_model(GetParam(), with(settings, {{"jacobian", "elastic"}}));
  for (const double h : {1e-3, 5e-3, 33e-3}) {
    EXPECT_NEAR(convergence_order(*exact, *exact, h), 2, 0.05) << h;
    EXPECT_NEAR(convergence_order(*exact, *stiff, h), 1, 0.05) << h;
  }
}

INSTANTIATE_TEST_SUITE_P(Reduced, Newton,
                         testing::Values("super_helix", "articulated_chain"));

class LargeSteps : public testing::TestWithParam<const char*> {
 protected:
  bool stable(const std::string& integrator, const std::string& jacobian, double step) {
    const StrandScene& scene = find_strand_scene("shake");
    const ModelSettings settings =
        with(scene.settings, {{"elements", "20"}, {"jacobian", jacobian}});
    const auto system = make_model(GetParam(), settings);
    const StabilityBounds bounds =
        stability_bounds(scene, parameters_of(GetParam(), settings), *system);
    Options options;
    options.step = step;
    const auto run = judge_run(integrator, *system, options, perturbed_start(*system),
                               scene.t_end, bounds);
    std::printf("%s, %s, %s, %g s: %s at %g s, %g m/s of %g\n", GetParam(),
                integrator.c_str(), jacobian.c_str(), step,
                std::string(name(run->broken)).c_str(), run->t, run->speed, bounds.speed);
    return run->stable();
  }
};

// The root moves by 5 cm at 3 Hz, nothing damps. "Stable" as the experiment
// stability_limit defines it: nothing but NaN, reach and a speed that no motion of the
// strand exceeds.
TEST_P(LargeSteps, OfTheFullyImplicitMethodAreStableOnShake) {
  for (const double step : {33e-3, 10e-3, 5e-3}) {
    EXPECT_TRUE(stable("backward_euler", "exact", step)) << step;
  }
}

TEST_P(LargeSteps, OfTheLinearlyImplicitMethodAreNot) {
  for (const double step : {33e-3, 10e-3, 5e-3, 1e-3}) {
    EXPECT_FALSE(stable("linearly_implicit_euler", "elastic", step)) << step;
  }
  EXPECT_TRUE(stable("linearly_implicit_euler", "elastic", 0.5e-3));
}

INSTANTIATE_TEST_SUITE_P(Reduced, LargeSteps,
                         testing::Values("super_helix", "articulated_chain"));

}  // namespace tress::test_newton
