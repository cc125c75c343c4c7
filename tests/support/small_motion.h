#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "contract/forms/material_points.h"
#include "models/catalogue.h"
#include "simulation/scene/scene.h"

/// Small motions of a strand of a scene about its start.
namespace tress::testing_support {

using Numbers = std::vector<double>;

/// The first strand of a scene, with its effects.
inline std::unique_ptr<System> system_of(const simulation::Scene& scene) {
  return scene.model->on_strand(scene.strands.front(), scene.model_options,
                                simulation::make_effects(scene));
}

/// The unknowns at the start.
struct Start {
  explicit Start(const System& system)
      : q(static_cast<std::size_t>(system.layout().coordinates)), v(q) {
    system.initial_state(q, v);
  }
  Numbers q, v;
};

inline double size_of(const Numbers& x) {
  double sum = 0;
  for (const double y : x) sum += y * y;
  return std::sqrt(sum);
}

/// The least frequency (rad/s) by inverse iteration. The ratio to the second is at least
/// 4, squared 16: 30 rounds leave 16^-30.
inline double frequency(System& system) {
  const Start start(system);
  const std::size_t n = start.q.size();
  const Numbers zero(n);
  Numbers x(n), force(n), none(n);
  EXPECT_EQ(system.residual(0, start.q, zero, zero, none), Status::ok);
  for (std::size_t i = 0; i < n; ++i) x[i] = 1 + 0.1 * std::sin(static_cast<double>(i));
  EXPECT_EQ(system.linearize(0, start.q, zero, zero, {0, 0, 1}), Status::ok);
  double growth = 0;
  for (int round = 0; round < 30; ++round) {
    const double before = size_of(x);
    EXPECT_EQ(system.residual(0, start.q, zero, x, force), Status::ok);
    for (std::size_t i = 0; i < n; ++i) force[i] -= none[i];
    EXPECT_EQ(system.solve(force, x), Status::ok);
    growth = size_of(x) / before;
    for (double& y : x) y /= growth * before;
  }
  return std::sqrt(1 / growth);
}

/// Moves q by `rounds` steps of Newton's method towards the equilibrium at time t.
inline void settle(System& system, double t, int rounds, Numbers& q) {
  const Numbers zero(q.size());
  Numbers r(q.size()), x(q.size());
  for (int round = 0; round < rounds; ++round) {
    EXPECT_EQ(system.residual(t, q, zero, zero, r), Status::ok);
    EXPECT_EQ(system.linearize(t, q, zero, zero, {0, 0, 1}), Status::ok);
    EXPECT_EQ(system.solve(r, x), Status::ok);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] -= x[i];
  }
}

/// The displacement of the tip (m) by small loads: the first step of Newton's method from
/// the start, which is exact to the square of the displacement over the length.
inline Vec tip_moved(System& system) {
  Start start(system);
  MaterialPoints& points = *system.material_points();
  Numbers places(3 * static_cast<std::size_t>(points.count()));
  const auto tip = [&] {
    points.positions(0, start.q, places);
    return load3(&places[places.size() - 3]);
  };
  const Vec before = tip();
  settle(system, 0, 1, start.q);
  return tip() - before;
}

}  // namespace tress::testing_support
