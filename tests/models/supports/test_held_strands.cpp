// Strands on supports against closed forms, and methods on a support that moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/forms/support_forces.h"
#include "experiments/numerics/fit.h"
#include "integrators/integrator_options.h"
#include "simulation/rest/supported_start.h"
#include "tests/models/reduced/work_of_motion.h"
#include "tests/models/supports/held_strand.h"

namespace tress::test_held_strands {

using namespace testing_support;

constexpr double gravity = 9.81;  // m/s^2

State start_of(System& system) {
  State start{zeros(system), zeros(system)};
  system.initial_state(start.q, start.v);
  return start;
}

Vec force_of(SupportedSystem& system, double t, In q, In v, std::size_t support) {
  std::vector<double> forces(3 * system.supports()), moments = forces;
  EXPECT_EQ(system.support_forces(t, q, v, forces, moments), Status::ok);
  return load3(&forces[3 * support]);
}

/// A cable of length L over a span L (1 - slack), nearly straight, pulls with w L/sqrt(24
/// slack); the next term of the catenary is 9 slack/10 or less. Multipliers of a nearly
/// straight strand lose digits as the rounding of a length over the slack, 1e-16/1e-9.
/// Helical elements err by order 2: 1.4e-4 with 20. Bar: 0.1 %.
TEST(HeldStrands, HaveTheForceOfATautCable) {
  constexpr double length = 0.1, radius = 40e-6, density = 1300;
  const double weight = density * gravity * std::numbers::pi * radius * radius;
  for (const double slack : {1e-4, 1e-6, 1e-8, 1e-9}) {
    auto strand = make_model("super_helix", {{"elements", "20"},
                                             {"motion", "free"},
                                             {"spin_rad_s", "0"},
                                             {"youngs_modulus_pa", "3e4"}});
    const double span = length * (1 - slack);
    SupportedSystem held(std::move(strand),
                         {support(0, {0, 0, 0}), support(20, {span, 0, 0})});
    const simulation::SupportedStart start = begin_on_supports(held, "test");
    EXPECT_GT(start.steps, 0);
    const State at = start_of(held);
    const Vec force = force_of(held, 0, at.q, at.v, 1);
    const double expected = weight * length / std::sqrt(24 * slack);
    std::printf("slack %g: force over that of a taut cable %.6f, %d steps\n", slack,
                force.x / expected, start.steps);
    EXPECT_NEAR(force.x / expected, 1, 1e-3) << slack;
    EXPECT_NEAR(force.z / (weight * length / 2), 1, 1e-3) << slack;
  }
}

/// Both ends on ball joints, pushed together: P = 4 K(k)^2 EI/L^2 at the distance L (2
/// E(k) /K(k) - 1), k the sine of half the slope at the ends. An element of constant
/// curvature errs by order 2: 7e-4 with 40.
TEST(HeldStrands, BuckleAsTheElastica) {
  constexpr double length = 0.1, radius = 40e-6, modulus = 3e9;
  const double bending = modulus * std::numbers::pi * std::pow(radius, 4) / 4;
  for (const double slope : {0.6, 1.2, 2.0}) {  // rad, at the ends
    const double k = std::sin(slope / 2), first = std::comp_ellint_1(k),
                 distance = length * (2 * std::comp_ellint_2(k) / first - 1);
    auto strand = make_model("super_helix", {{"elements", "40"},
                                             {"motion", "free"},
                                             {"spin_rad_s", "0"},
                                             {"modes", "bend"},
                                             {"gravity_m_s2", "0"}});
    SupportedSystem held(std::move(strand),
                         {support(0, {0, 0, 0}), support(40, {distance, 0, 0})});
    const simulation::SupportedStart start = begin_on_supports(held, "test");
    const State at = start_of(held);
    const Vec left = force_of(held, 0, at.q, at.v, 0),
              right = force_of(held, 0, at.q, at.v, 1);
    const double expected = 4 * first * first * bending / (length * length);
    std::printf("pushed by %.3f: force over that of the elastica %.6f, %d steps\n",
                1 - distance / length, left.x / expected, start.steps);
    EXPECT_NEAR(left.x / expected, 1, 5e-3);
    EXPECT_NEAR(right.x / expected, -1, 5e-3);
  }
}

/// A stiff bar on a ball joint, from the horizontal: T = 4 sqrt(2 L/(3 g)) K(sin 45 deg).
/// Methods of order 2 err by 2e-4 of it with 139 steps a period; the bar's own bending by
/// 4e-6.
TEST(HeldStrands, SwingAsAPendulumOnABallJoint) {
  auto strand = make_model(
      "super_helix",
      {{"elements", "4"}, {"motion", "free"}, {"spin_rad_s", "0"}, {"radius_m", "1e-3"}});
  SupportedSystem held(std::move(strand), {support(0, {0, 0, 0})});
  const State start = start_of(held);
  const double period =
      4 * std::sqrt(2 * 0.1 / (3 * gravity)) * std::comp_ellint_1(std::sqrt(0.5));
  Options options;
  options.formulation = Formulation::index3;
  options.step = period / 139;
  MaterialPoints& points = *held.material_points();
  std::vector<double> crossings, x(15);
  double before = 0, then = 0;
  const Simulation run = simulate(
      "generalized_alpha", held, options, start, 2.1 * period, [&](double t, In q, In) {
        points.positions(t, q, x);
        const double now = x[12];
        if (now * before < 0) {
          crossings.push_back(then + (t - then) * before / (before - now));
        }
        before = now;
        then = t;
        return true;
      });
  ASSERT_EQ(run.status, Status::ok) << run.failure;
  ASSERT_GE(crossings.size(), 4U);
  // From the first crossing to the third; linear interpolation errs by (h/T)^3.
  const double found = crossings[2] - crossings[0];
  std::printf("period over that of a rigid bar: %.6f\n", found / period);
  EXPECT_NEAR(found / period, 1, 5e-4);
}

/// A curl whose tip is led away in 0.1 s.
std::unique_ptr<SupportedSystem> led(const std::string& model = "super_helix") {
  return held_at_tip(model,
                     {{"elements", "6"},
                      {"natural_curvature_per_m", "20"},
                      {"radius_m", "1e-3"},
                      {"youngs_modulus_pa", "1e6"}},
                     {-0.01, 0.02, 0.03}, 0.1);
}

State end_of(SupportedSystem& system, const std::string& method, Formulation formulation,
             double step, Vec* force = nullptr) {
  Options options;
  options.formulation = formulation;
  options.step = step;
  const Simulation run = simulate(method, system, options, start_of(system), 0.1);
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  if (force != nullptr) *force = force_of(system, 0.1, run.state.q, run.state.v, 0);
  return run.state;
}

/// Errors of the state at the end against esdirk43 with 1600 steps.
TEST(HeldStrands, KeepTheOrdersOfMethodsOnASupportThatMoves) {
  const auto system = led();
  const State reference =
      end_of(*system, "esdirk43", Formulation::projection, 0.1 / 1600);
  std::vector<double> q_typ = zeros(*system), v_typ = q_typ;
  system->scale(q_typ, v_typ);
  struct Case {
    const char* method;
    Formulation formulation;
    double order;
    int steps;
  };
  for (const Case& c : {Case{"backward_euler", Formulation::index3, 1, 400},
                        Case{"generalized_alpha", Formulation::index3, 2, 200},
                        Case{"bdf2", Formulation::index3, 2, 400},
                        Case{"esdirk43", Formulation::projection, 4, 50}}) {
    std::vector<double> steps, errors;
    for (const int count : {c.steps, 2 * c.steps}) {
      const State end = end_of(*system, c.method, c.formulation, 0.1 / count);
      steps.push_back(0.1 / count);
      errors.push_back(relative_difference(end.q, reference.q, q_typ));
    }
    const double order = experiments::log_log_slope(steps, errors);
    std::printf("%s: error %.2e, %.2e, order %.2f\n", c.method, errors[0], errors[1],
                order);
    // Over one halving of steps the next term of the error changes the order by 0.3.
    EXPECT_NEAR(order, c.order, 0.3) << c.method;
  }
}

/// What the support does in 0.05 s is what the energy gains, by the trapezoidal rule in
/// time, of order 2 as the motion itself. With a root that moves as well, its own work
/// depends on the support.
class MovingSupport : public testing::TestWithParam<StrandCase> {};

TEST_P(MovingSupport, GivesItsWorkToTheStrand) {
  const double order = order_of_work(
      GetParam().name,
      []() -> std::unique_ptr<System> {
        const ModelSettings settings =
            with(GetParam().settings, {{"elements", "5"},
                                       {"radius_m", "1e-3"},
                                       {"youngs_modulus_pa", "1e6"},
                                       {"natural_curvature_per_m", "20"},
                                       {"motion", "swing"},
                                       {"amplitude_m", "0.005"}});
        auto strand = make_model(GetParam().model, settings);
        Support clamp = clamp_of_tip(*strand, std::string(GetParam().model), settings,
                                     HeldPart::frame, {-0.01, 0.01, 0.02}, 0.05);
        clamp.path.rotations.push_back({{0, 1, 1}, rests({0, 0.05}, {0, 0.4})});
        clamp.half_edge.friction = 1e-4 * clamp.half_edge.stiffness;
        return std::make_unique<SupportedSystem>(std::move(strand), std::vector{clamp});
      },
      {0.4e-3, 0.2e-3, 0.1e-3});
  EXPECT_NEAR(order, 2, 0.3);
}

INSTANTIATE_TEST_SUITE_P(
    Models, MovingSupport,
    testing::Values(StrandCase{"super_helix", "super_helix", {}},
                    StrandCase{"super_clothoid", "super_clothoid", {}},
                    StrandCase{"articulated_chain", "articulated_chain", {}},
                    StrandCase{"der", "der", {}},
                    StrandCase{"der_inextensible", "der", {{"stretch", "inextensible"}}}),
    [](const auto& test) { return test.param.name; });

}  // namespace tress::test_held_strands
