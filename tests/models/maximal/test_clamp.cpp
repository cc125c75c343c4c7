#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contract/forms/material_points.h"
#include "tests/models/reduced/strand_cases.h"
#include "tests/models/reduced/work_of_motion.h"
#include "tests/support/tangent.h"

namespace tress::test_clamp {

using namespace testing_support;

class MovingClamp : public testing::TestWithParam<StrandCase> {};

// What the clamp does in 0.05 s is what the energy gains, by the trapezoidal rule in
// time, of order 2 as the motion itself; terms of the next order are a few per cent of
// it.
TEST_P(MovingClamp, GivesItsWorkToTheStrand) {
  const double order =
      order_of_work(GetParam().name,
                    [] {
                      return GetParam().make({{"motion", "shake_rotate"},
                                              {"elements", "5"},
                                              {"radius_m", "1e-3"},
                                              {"youngs_modulus_pa", "1e6"}});
                    },
                    {0.2e-3, 0.1e-3, 0.05e-3});
  EXPECT_NEAR(order, 2, 0.1);
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
