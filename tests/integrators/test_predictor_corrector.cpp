#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "experiments/numerics/fit.h"
#include "integrators/formulation/projection.h"
#include "integrators/formulation/relaxation.h"
#include "integrators/integrator_options.h"
#include "math/vec3.h"
#include "simulation/run/simulation.h"

namespace tress::test_predictor_corrector {

using namespace experiments;

constexpr double length = 0.1;  // m

ModelSettings shaken(std::string_view springs) {
  return {{"motion", "shake"},
          {"root_tangent", "x"},
          {"initial", "natural"},
          {"amplitude_m", "0.05"},
          {"frequency_hz", "3"},
          {"elements", "20"},
          {"stretch_springs", std::string(springs)}};
}

Options corrected(double step) {
  Options options;
  options.formulation = Formulation::correction;
  options.step = step;
  return options;
}

/// Largest length error over the run.
double stretch(std::string_view integrator, System& system, const Options& options,
               double t_end) {
  double most = 0;
  const Simulation run = simulate(
      integrator, system, options, initial_state(system), t_end, [&](double t, In q, In) {
        most = std::max(most, system.material_points()->stretch(t, q).value());
        return true;
      });
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  return most;
}

TEST(PredictorCorrector, KeepsLengthsWhereSpringsGiveWay) {
  const auto links = make_model("inextensible_strand", shaken("linear"));
  const Options options = corrected(1 / 120.0);
  const double tolerance =
      own_options(options, find_integrator("predictor_corrector").parameters)
          .number("correction_tolerance");
  // g over its scale is a length's error, to first order; to second, half its square
  // more.
  EXPECT_LE(stretch("predictor_corrector", *links, options, 1), 1.001 * tolerance);
  EXPECT_LE(tolerance, 1e-6);

  ModelSettings springs = shaken("");
  springs.pop_back();
  const auto soft = make_model("mass_spring", springs);
  Options plain;
  plain.step = 1 / 120.0;
  EXPECT_GT(stretch("linearly_implicit_euler", *soft, plain, 1), 0.01);
}

TEST(PredictorCorrector, MovesTheCentreOfMassAsTheForcesDo) {
  // Lengths are corrected by equal and opposite impulses: a strand thrown without gravity
  // keeps its linear momentum, of which it has none here but by rounding.
  const auto strand =
      make_model("inextensible_strand",
                 {{"motion", "free"}, {"gravity_m_s2", "0"}, {"elements", "8"}});
  Energetics& energetics = *strand->energetics();
  const State start = initial_state(*strand);
  const Momentum before = energetics.momentum(0, start.q, start.v).value();
  const Simulation run =
      simulate("predictor_corrector", *strand, corrected(1e-3), start, 0.1);
  ASSERT_EQ(run.status, Status::ok) << run.failure;
  const Momentum after = energetics.momentum(run.t, run.state.q, run.state.v).value();
  const double fastest = length * 10;  // m/s: the spin of 10 rad/s
  const double mass = before.linear[1] / (fastest / 2) * std::sqrt(3);
  ASSERT_GT(mass, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    // A hundred steps of sums of eight products, 1e-16 each.
    EXPECT_NEAR(after.linear[i], before.linear[i], 1e-13 * mass * fastest);
  }
}

TEST(PredictorCorrector, ConvergesToTheConstrainedMotion) {
  const auto strand =
      make_model("inextensible_strand",
                 {{"elements", "4"}, {"motion", "shake"}, {"youngs_modulus_pa", "1e8"}});
  constexpr double t_end = 0.1;
  Options exact;
  exact.formulation = Formulation::rattle;
  exact.step = 2e-5;
  const State start = initial_state(*strand);
  const Simulation reference = simulate("rattle", *strand, exact, start, t_end);
  ASSERT_EQ(reference.status, Status::ok) << reference.failure;
  for (const std::string_view how : {"impulse", "position"}) {
    std::vector<double> steps, errors;
    for (const double step : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
      Options options = corrected(step);
      apply(options, "correction", how, "test");
      const Simulation run =
          simulate("predictor_corrector", *strand, options, start, t_end);
      ASSERT_EQ(run.status, Status::ok) << run.failure;
      double most = 0;
      for (std::size_t i = 0; i < start.q.size(); ++i) {
        most = std::max(most, std::abs(run.state.q[i] - reference.state.q[i]));
      }
      steps.push_back(step);
      errors.push_back(most / length);
    }
    if (how == "impulse") {
      EXPECT_NEAR(log_log_slope(steps, errors), 1, 0.25);
    } else {
      // Velocities that never learn of the correction keep falling: no convergence.
      EXPECT_GT(errors.back(), 0.5 * errors.front());
    }
  }
}

TEST(Relaxation, ReachesTheConstraintsBesideTheirProjection) {
  constexpr int links = 12;
  const auto strand = make_model("inextensible_strand", {{"elements", "12"}});
  State state = initial_state(*strand);
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    state.q[i] *= 1 + 1e-4 * std::sin(static_cast<double>(i));
  }
  std::vector<double> relaxed = state.q, projected = state.q, v = state.v;
  constexpr double tolerance = 1e-13;
  ASSERT_EQ(Relaxation(*strand, tolerance).positions(0, relaxed), Status::ok);
  EXPECT_LE(strand->material_points()->stretch(0, relaxed).value(), 1.001 * tolerance);

  Options options;
  options.formulation = Formulation::acceleration;
  Dynamics dynamics(*strand, options);
  ASSERT_EQ(Projection(dynamics).project(0, projected, v), Status::ok);
  double moved = 0, apart = 0;
  for (std::size_t i = 0; i < relaxed.size(); ++i) {
    moved = std::max(moved, std::abs(relaxed[i] - state.q[i]));
    apart = std::max(apart, std::abs(relaxed[i] - projected[i]));
  }
  // Both move along M^-1 G^T, of states on their ways, whose links differ in direction by
  // up to what they moved over the length of a link: so much of what moved is what they
  // differ by, summed over the links up to a node.
  EXPECT_GT(moved, 1e-5 * length);
  EXPECT_LE(apart, links * moved * (moved / (length / links)));
  EXPECT_LE(apart, 0.2 * moved);
}

TEST(Relaxation, RefusesWhatIsNotNearTheConstraints) {
  const auto strand = make_model("inextensible_strand", {{"elements", "12"}});
  std::vector<double> q(initial_state(*strand).q.size(),
                        std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(Relaxation(*strand, 1e-8).positions(0, q), Status::retry);
}

}  // namespace tress::test_predictor_corrector
