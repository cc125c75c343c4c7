#pragma once

#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

/// What implicit_midpoint loses of a free strand in 0.1 s: root mean square of the
/// energy's drift over the largest kinetic energy, and the largest drift of linear and
/// angular momentum over their sizes.
struct Drift {
  double energy, momentum;
};
inline Drift drift(System& system, double step) {
  Energetics& energetics = *system.energetics();
  State start{zeros(system), zeros(system)};
  system.initial_state(start.q, start.v);
  const double before = energetics.energy(0, start.q, start.v).total();
  Momentum was, now;
  EXPECT_TRUE(energetics.momentum(0, start.q, start.v, was));
  Options options;
  options.step = step;
  options.newton_tolerance = 1e-12;
  double square = 0, kinetic = 0, momentum = 0;
  const auto apart = [](const std::array<double, 3>& x, const std::array<double, 3>& y) {
    const Vec size = load3(y.data()), off = load3(x.data()) - size;
    EXPECT_GT(dot(size, size), 0);
    return std::sqrt(dot(off, off) / dot(size, size));
  };
  const Simulation run = simulate(
      "implicit_midpoint", system, options, start, 0.1, [&](double t, In q, In v) {
        const Energy e = energetics.energy(t, q, v);
        square += std::pow(e.total() - before, 2);
        kinetic = std::max(kinetic, e.kinetic);
        energetics.momentum(t, q, v, now);
        momentum = std::max(
            {momentum, apart(now.linear, was.linear), apart(now.angular, was.angular)});
        return true;
      });
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  return {std::sqrt(square / static_cast<double>(run.stats.steps)) / kinetic, momentum};
}

}  // namespace tress::testing_support
