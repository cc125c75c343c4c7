#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress::simulation {

/// A catalogue model with the given parameters.
std::unique_ptr<System> make_model(std::string_view id,
                                   const ModelSettings& settings = {});

/// Coordinates and rates of a system.
struct State {
  std::vector<double> q, v;  // coordinates (n), rates (n)
};

/// Returns the state from System::initial_state().
State initial_state(const System& system);

/// Result of a run; the state is the one at `t`.
struct Simulation {
  Status status;        // `ok` if all stops were reached
  std::string failure;  // what ended the run; empty if it ended well
  double t;             // time of the state, s
  State state;          // state at `t`
  Stats stats;          // work done
  Limit limit;          // of Options that ended it, if any
};

/// One run of the system, which is reset first, from `start` at t = 0 through all `stops`
/// (ascending), which are reached exactly; `at_stop` receives the state at each.
Simulation simulate(std::string_view integrator, System& system, const Options& options,
                    const State& start, std::span<const double> stops,
                    const std::function<void(const State&)>& at_stop,
                    const Observer& each_step = {});

/// One run from `start` at t = 0 to t_end with a fresh integrator.
Simulation simulate(std::string_view integrator, System& system, const Options& options,
                    const State& start, double t_end, const Observer& each_step = {});

/// Runs as simulate() does, with a method constructed by the caller, who can query its
/// stats during the run.
Simulation run_method(Integrator& method, System& system, const State& start,
                      std::span<const double> stops,
                      const std::function<void(const State&)>& at_stop,
                      const Observer& each_step = {});

}  // namespace tress::simulation
