#pragma once

#include "simulation/run/simulation.h"

namespace tress::simulation {

/// As simulate(), by a method that the caller has made of the system, and may ask for its
/// stats meanwhile.
Simulation run_method(Integrator& method, System& system, const State& start,
                      std::span<const double> stops,
                      const std::function<void(const State&)>& at_stop,
                      const Observer& each_step = {});

}  // namespace tress::simulation
