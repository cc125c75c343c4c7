#pragma once

#include "simulation/run/simulation.h"

namespace tress::simulation {

/// As simulate(), with a method constructed by the caller, who can query its stats during
/// the run.
Simulation run_method(Integrator& method, System& system, const State& start,
                      std::span<const double> stops,
                      const std::function<void(const State&)>& at_stop,
                      const Observer& each_step = {});

}  // namespace tress::simulation
