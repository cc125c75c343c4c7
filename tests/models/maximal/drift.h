#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "contract/forms/energetics.h"
#include "experiments/numerics/fit.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

using namespace experiments;

/// A bent strand of six elements thrown into space with a spin of 10 rad/s.
inline const ModelSettings bent_throw = {{"elements", "6"},
                                         {"motion", "free"},
                                         {"gravity_m_s2", "0"},
                                         {"youngs_modulus_pa", "1e6"},
                                         {"radius_m", "1e-3"},
                                         {"initial", "bent"},
                                         {"initial_curvature_per_m", "20"}};

/// What implicit_midpoint loses of a free strand in `duration`: root mean square of the
/// energy's drift over the largest kinetic energy, and the largest drift of linear and
/// angular momentum over their sizes.
struct Drift {
  double energy, momentum;
};
inline Drift drift(System& system, double step, double duration = 0.1) {
  Energetics& energetics = *system.energetics();
  State start{zeros(system), zeros(system)};
  system.initial_state(start.q, start.v);
  const double before = energetics.energy(0, start.q, start.v).total();
  const Momentum was = energetics.momentum(0, start.q, start.v).value();
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
      "implicit_midpoint", system, options, start, duration, [&](double t, In q, In v) {
        const Energy e = energetics.energy(t, q, v);
        square += std::pow(e.total() - before, 2);
        kinetic = std::max(kinetic, e.kinetic);
        const Momentum now = energetics.momentum(t, q, v).value();
        momentum = std::max(
            {momentum, apart(now.linear, was.linear), apart(now.angular, was.angular)});
        return true;
      });
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  return {std::sqrt(square / static_cast<double>(run.stats.steps)) / kinetic, momentum};
}

/// The rule keeps the momenta, bilinear in q and v, to `momentum`, and the energy at
/// order 2 over `steps` (s).
inline void expect_midpoint_keeps(std::string_view model, const ModelSettings& thrown,
                                  const std::vector<double>& steps, double momentum) {
  std::vector<double> errors;
  for (const double step : steps) {
    const auto system = make_model(model, thrown);
    const Drift off = drift(*system, step);
    errors.push_back(off.energy);
    std::printf("%s, step %g s: energy off by %.2e, momentum by %.2e\n",
                std::string(model).c_str(), step, off.energy, off.momentum);
    EXPECT_LE(off.momentum, momentum);
  }
  EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.1);
}

}  // namespace tress::testing_support
