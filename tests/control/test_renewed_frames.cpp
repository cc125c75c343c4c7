// Reference frames that follow the motion leave no trace in methods with a memory.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "contract/forms/moving_history.h"
#include "math/vec3.h"
#include "models/catalogue.h"
#include "simulation/run/simulation.h"
#include "simulation/run/world.h"

namespace tress::test_renewed_frames {

using namespace models;
using namespace simulation;

struct Motion {
  std::vector<double> q, v, a;
};

class CarriedMotion
    : public testing::TestWithParam<std::pair<std::string_view, std::size_t>> {};

/// A free strand of so many nodes, turned by 74 degrees: every edge gets a new reference.
/// Along a parabola of the old coordinates, carried velocities are the derivative of the
/// carried positions, and carried accelerations that of the velocities. Central
/// differences over s err by s^2/6 of the third derivative: rates are of 1/s to 1e2/s, so
/// that is 1e-8/6 1e4 = 2e-5 of a value at most.
TEST_P(CarriedMotion, IsOneMotionInNewCoordinates) {
  const auto [model, nodes] = GetParam();
  const auto system = make_model(
      model, {{"elements", "6"}, {"motion", "free"}, {"natural_curvature_per_m", "40"}});
  State state = initial_state(*system);
  const double c = std::cos(1.3), s = std::sin(1.3);
  std::vector<double> a(state.q.size());
  for (std::size_t i = 0; i < nodes; ++i) {
    const Vec x = load3(&state.q[3 * i]);
    store3(Vec{c * x.x - s * x.z, x.y + 1e-3 * std::sin(i), s * x.x + c * x.z},
           &state.q[3 * i]);
    store3(0.1 * Vec{std::cos(i), 1, std::sin(i)}, &state.v[3 * i]);
    store3(Vec{std::sin(2 * i), std::cos(3 * i), 1}, &a[3 * i]);
  }
  for (std::size_t k = 3 * nodes; k < state.q.size(); ++k) {
    state.q[k] = 0.3;
    state.v[k] = 2;
    a[k] = -5;
  }
  const State before = state;
  ASSERT_TRUE(system->accept(0, state.q, state.v));
  const auto carried = [&](double time) {
    Motion m{before.q, before.v, a};
    for (std::size_t k = 0; k < a.size(); ++k) {
      m.q[k] += time * before.v[k] + time * time / 2 * a[k];
      m.v[k] += time * a[k];
    }
    EXPECT_TRUE(tress::carry(*system, time, m.q, m.v, m.a));
    return m;
  };
  constexpr double step = 1e-4;
  const Motion now = carried(0), later = carried(step), earlier = carried(-step);
  double changed = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(now.q[k], state.q[k], 1e-12);
    EXPECT_NEAR(now.v[k], state.v[k], 1e-10);
    EXPECT_NEAR((later.q[k] - earlier.q[k]) / (2 * step), now.v[k],
                2e-5 * (1 + std::abs(now.v[k])));
    EXPECT_NEAR((later.v[k] - earlier.v[k]) / (2 * step), now.a[k],
                2e-4 * (1 + std::abs(now.a[k])));
    changed = std::max(changed, std::abs(now.a[k] - a[k]));
  }
  EXPECT_GT(changed, 1);  // accelerations of angles are others now
}

INSTANTIATE_TEST_SUITE_P(Maximal, CarriedMotion,
                         testing::Values(std::pair("der", 7),
                                         std::pair("dynamic_spline", 9)),
                         [](const auto& test) { return std::string(test.param.first); });

/// Height of the tip of a released hair, by `modulus` times that of hair.asian.
double tip(const std::string& integrator, double modulus) {
  const Scene scene = parse_scene(
      "title = \"t\"\nduration_s = 0.4\nframes_per_s = 10\n[model]\nid = \"der\"\n"
      "[integrator]\nid = \"" +
          integrator +
          "\"\ndt_s = 0.004\n[material]\nname = \"hair.asian\"\nyoungs_modulus_pa = " +
          std::to_string(3.89e9 * modulus) +
          "\n[strand]\nlength_m = 0.2\nelements = 10\nroot_tangent = [1, 0, 0]\n"
          "shape = \"helix\"\n[effects.gravity]\n",
      "released.toml");
  World world(scene);
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    EXPECT_EQ(world.advance(scene.time_of(frame)), Status::ok);
  }
  return world.positions().back();
}

class Derivative : public testing::TestWithParam<const char*> {};

/// A difference over 1e-3 of a parameter is the derivative, and changes from one to the
/// next by some 1e-3 of itself. Where methods restart at renewals, which come a step
/// sooner or later, single differences are off by a third.
TEST_P(Derivative, DoesNotJumpWhereAFrameIsRenewedAStepSooner) {
  std::vector<double> differences;
  double last = tip(GetParam(), 1);
  for (int k = 1; k <= 16; ++k) {
    const double next = tip(GetParam(), 1 + 1e-3 * k);
    differences.push_back(next - last);
    last = next;
  }
  double mean = 0, largest = 0;
  for (const double d : differences) mean += d / static_cast<double>(differences.size());
  for (std::size_t k = 1; k < differences.size(); ++k) {
    largest = std::max(largest, std::abs(differences[k] - differences[k - 1]));
  }
  std::printf("%s: differences change by %.2g of their mean\n", GetParam(),
              largest / std::abs(mean));
  EXPECT_LE(largest, 0.02 * std::abs(mean));
}

INSTANTIATE_TEST_SUITE_P(WithMemory, Derivative,
                         testing::Values("bdf2", "generalized_alpha"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace tress::test_renewed_frames
