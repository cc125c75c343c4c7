#include <gtest/gtest.h>

#include "experiments/problems/strand_scenes.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::test_planar {

using namespace experiments;

using namespace testing_support;

// A strand of fewer unknowns an element does in its plane, or without twist, what the
// full one does there: the same equations without the components that stay 0.

struct Plane {
  std::string name, model;
  ModelSettings settings;
  std::string integrator, jacobian;
};

void PrintTo(const Plane& plane, std::ostream* out) { *out << plane.name; }

class InThePlane : public testing::TestWithParam<Plane> {
 protected:
  Simulation run(const std::string& modes) const {
    const Plane& plane = GetParam();
    const auto system = make_model(
        plane.model,
        with(plane.settings, {{"modes", modes}, {"jacobian", plane.jacobian}}));
    Options options;
    options.step = 5e-4;
    options.newton_tolerance = 1e-13;
    return simulate(plane.integrator, *system, options, initial_state(*system), 0.5);
  }
};

/// Component k of `dofs`, for an element or for each function of it in turn.
std::vector<double> component(const std::vector<double>& x, std::size_t k,
                              std::size_t dofs) {
  std::vector<double> part;
  for (std::size_t i = k; i < x.size(); i += dofs) part.push_back(x[i]);
  return part;
}

TEST_P(InThePlane, FewerModesMoveTheSame) {
  const Simulation planar = run("bend_planar");
  ASSERT_EQ(planar.status, Status::ok) << planar.failure;
  ASSERT_GT(largest(planar.state.v), 1);
  for (const std::string modes : {"bend_twist", "bend"}) {
    const std::size_t dofs = modes == "bend" ? 2 : 3;
    const Simulation full = run(modes);
    ASSERT_EQ(full.status, Status::ok) << full.failure;
    // 1000 steps, each with rounding on a condition of 1e3 at most, 2e-13, or the
    // stage's tolerance.
    const auto expect_same = [&](const std::vector<double>& x,
                                 const std::vector<double>& flat) {
      EXPECT_LE(largest(plus(component(x, dofs - 2, dofs), -1, flat)),
                1e-9 * largest(flat));
      EXPECT_LE(largest(component(x, dofs - 1, dofs)), 1e-9 * largest(flat));
      if (dofs == 3) {
        EXPECT_LE(largest(component(x, 0, 3)), 1e-9 * largest(flat));
      }
    };
    expect_same(full.state.q, planar.state.q);
    expect_same(full.state.v, planar.state.v);
  }
}

std::vector<Plane> planes() {
  // Down is in the plane of x and z, where e1 bends; so is the shaking of a strand that
  // starts upwards or downwards.
  const ModelSettings release = {{"root_tangent", "x"},
                                 {"natural_curvature_per_m", "30"}};
  const ModelSettings shake = {{"root_tangent", "down"},
                               {"motion", "shake"},
                               {"initial", "bent"},
                               {"initial_curvature_per_m", "10"},
                               {"drag_kg_m_s", "1e-5"}};
  std::vector<Plane> all;
  for (const std::string model : {"super_helix", "articulated_chain"}) {
    all.push_back(
        {model + "_release", model, release, "linearly_implicit_euler", "elastic"});
    all.push_back({model + "_release_exact", model, release, "backward_euler", "exact"});
    all.push_back({model + "_shake", model, shake, "linearly_implicit_euler", "elastic"});
    all.push_back({model + "_shake_exact", model, shake, "implicit_midpoint", "exact"});
  }
  const ModelSettings few = {{"elements", "4"}};
  all.push_back({"super_clothoid_release", "super_clothoid", with(release, few),
                 "linearly_implicit_euler", "elastic"});
  all.push_back({"super_clothoid_shake_exact", "super_clothoid", with(shake, few),
                 "implicit_midpoint", "exact"});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Reduced, InThePlane, testing::ValuesIn(planes()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace tress::test_planar
