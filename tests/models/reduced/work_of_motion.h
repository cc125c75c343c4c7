#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contract/forms/energetics.h"
#include "experiments/numerics/fit.h"
#include "integrators/integrator_options.h"
#include "simulation/run/simulation.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

/// Returns the order with which the work of prescribed motion in 0.05 s, by the
/// trapezoidal rule in time, comes to what the energy gains. `steps` are in s. The rule
/// and generalized_alpha, which moves the strand, have order 2. `relative` receives the
/// errors over the work that is moved.
inline double order_of_work(const std::string& name,
                            const std::function<std::unique_ptr<System>()>& make,
                            const std::vector<double>& steps,
                            std::vector<double>* relative = nullptr) {
  std::vector<double> errors;
  for (const double step : steps) {
    const auto system = make();
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
    errors.push_back(std::abs(work - gained) / moved);
    std::printf("%s, step %g s: work off by %.2e of %.2e J\n", name.c_str(), step,
                errors.back(), moved);
  }
  if (relative != nullptr) *relative = errors;
  return experiments::log_log_slope(steps, errors);
}

}  // namespace tress::testing_support
