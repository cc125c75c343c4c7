#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress {

using ModelSettings = std::vector<std::pair<std::string, std::string>>;

/// A model of the catalogue with the given parameters set.
std::unique_ptr<System> make_model(std::string_view id,
                                   const ModelSettings& settings = {});

struct State {
  std::vector<double> q, v;
};

State initial_state(const System& system);

/// How a run ended; the state is the one at `t`, wherever that was.
struct Simulation {
  Status status;
  std::string failure;
  double t;
  State state;
  Stats stats;
};

/// One run from `start` at t = 0 to t_end with a fresh integrator.
Simulation simulate(std::string_view integrator, System& system, const Options& options,
                    const State& start, double t_end, const Observer& each_step = {});

}  // namespace tress
