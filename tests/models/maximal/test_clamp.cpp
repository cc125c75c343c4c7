#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "experiments/numerics/fit.h"
#include "integrators/integrator_options.h"
#include "tests/models/reduced/strand_cases.h"
#include "tests/support/tangent.h"

namespace tress::test_clamp {

using namespace experiments;

using namespace testing_support;

class MovingClamp : public testing::TestWithParam<StrandCase> {};

// What the clamp does in 0.05 s is what the energy gains, by the trapezoidal rule in
// time, of order 2 as the motion itself; terms of the next order are a few per cent of
// it.
TEST_P(MovingClamp, GivesItsWorkToTheStrand) {
  std::vector<double> steps, errors;
  for (const double step : {0.2e-3, 0.1e-3, 0.05e-3}) {
    const auto system = GetParam().make({{"motion", "shake_rotate"},
                                         {"elements", "5"},
                                         {"radius_m", "1e-3"},
                                         {"youngs_modulus_pa", "1e6"}});
    Energetics& energetics = *system->energetics();
    State start{zeros(*system), zeros(*system)};
    system->initial_state(start.q, start.v);
    Options options;
    options.step = step;
    apply(options, "rho_inf", "1", "test");
    options.newton_tolerance = 1e-10;
    if (system->layout().constraints > 0) options.formulation = Formulation::projection;
    const double before = energetics.energy(0, start.q, start.v).total();
    double work = 0, moved = 0, gained = 0, now = 0;
    double power = energetics.power(0, start.q, start.v);
    const Simulation run = simulate(
        "generalized_alpha", *system, options, start, 0.05, [&](double t, In q, In v) {
          const double next = energetics.power(t, q, v);
          work += (t - now) * (power + next) / 2;
          moved += (t - now) * std::abs(next);
          power = next;
          now = t;
          gained = energetics.energy(t, q, v).total() - before;
          return true;
        });
    EXPECT_EQ(run.status, Status::ok) << run.failure;
    steps.push_back(step);
    errors.push_back(std::abs(work - gained) / moved);
    std::printf("%s, step %g s: work off by %.2e of %.2e J\n", GetParam().name.c_str(),
                step, errors.back(), moved);
  }
  EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Maximal, MovingClamp,
    testing::Values(StrandCase{"der", "der", {}},
                    StrandCase{"der_inextensible", "der", {{"stretch", "inextensible"}}},
                    StrandCase{"corde", "corde", {}},
                    StrandCase{"xpbd_cosserat", "xpbd_cosserat", {}},
                    StrandCase{"dynamic_spline", "dynamic_spline", {{"twist", "none"}}},
                    StrandCase{"dynamic_spline_curly",
                               "dynamic_spline",
                               {{"natural_curvature_per_m", "20"},
                                {"natural_twist_per_m", "10"},
                                {"internal_friction_kg_m3_s", "1e-9"}}},
                    StrandCase{"kirchhoff_nodal",
                               "kirchhoff_nodal",
                               {{"natural_curvature_per_m", "20"},
                                {"internal_friction_kg_m3_s", "1e-9"}}}),
    [](const auto& test) { return test.param.name; });

/// Coordinates that move no point: angles of sections.
std::vector<std::size_t> angles_of(System& system, const State& state) {
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count())), moved(x.size());
  points.positions(0, state.q, x);
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    std::vector<double> q = state.q;
    q[i] += 1e-3;
    points.positions(0, q, moved);
    if (moved == x) all.push_back(i);
  }
  return all;
}

const ModelSettings turning = {{"motion", "rotate"},
                               {"root_tangent", "up"},
                               {"head_radius_m", "0"},
                               {"gravity_m_s2", "0"},
                               {"elements", "5"}};

/// The largest moment (N m) that internal friction puts on an angle of a straight hair
/// whose clamp turns about its tangent, where all its sections turn at `rate`.
double friction_at(const std::string& model, double rate) {
  std::vector<double> forces[2];
  std::vector<std::size_t> angles;
  for (const bool rubbed : {false, true}) {
    const auto system = make_model(
        model, with(turning, {{"internal_friction_kg_m3_s", rubbed ? "1e-9" : "0"}}));
    State state = initial_state(*system);
    angles = angles_of(*system, state);
    EXPECT_GE(angles.size(), 5);
    std::ranges::fill(state.v, 0.0);
    for (const std::size_t i : angles) state.v[i] = rate;
    forces[rubbed ? 1 : 0] = residual(*system, state.q, state.v, zeros(*system));
  }
  double largest = 0;
  for (const std::size_t i : angles) {
    largest = std::max(largest, std::abs(forces[1][i] - forces[0][i]));
  }
  return largest;
}

// What turns with its clamp is not twisted; what stays behind is, in its first element,
// by the whole rate. Models say by angles what others say by quaternions.
TEST(TurningClamp, FrictionLeavesAloneWhatTurnsWithIt) {
  for (const std::string model : {"der", "dynamic_spline"}) {
    const double rate = root_motion(parameters_of(model, turning)).at(t0).omega.z;
    const double behind = friction_at(model, 0);
    EXPECT_GT(behind, 0) << model;
    EXPECT_LE(friction_at(model, rate), 1e-12 * behind) << model;
    EXPECT_NEAR(friction_at(model, -rate), 2 * behind, 1e-12 * behind) << model;
  }
}

}  // namespace tress::test_clamp
