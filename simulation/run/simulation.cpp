#include "simulation/run/simulation.h"

#include <algorithm>

#include "contract/forms/teleports.h"
#include "contract/input_error.h"
#include "simulation/run/guard.h"
#include "simulation/run/remedy.h"

namespace tress::simulation {

std::unique_ptr<System> make_model(std::string_view id, const ModelSettings& settings) {
  const ModelEntry& entry = find_model(id);
  Parameters parameters(setup_parameters(entry), "model " + std::string(id));
  for (const auto& [key, value] : settings) parameters.set(key, value);
  return entry.make(parameters);
}

State initial_state(const System& system) {
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  State state{std::vector<double>(n), std::vector<double>(n)};
  system.initial_state(state.q, state.v);
  return state;
}

Simulation run_method(Integrator& method, System& system, const State& start,
                      std::span<const double> stops,
                      const std::function<void(const State&)>& at_stop,
                      const Observer& each_step) {
  const Teleports* const jumps = teleports(system);
  refuse_if(jumps != nullptr && !stops.empty() && jumps->next_teleport(0) <= stops.back(),
            "a root that teleports, which this program does not follow", "[root]",
            "leave out rows with the same time, or use `simulate`");
  State state = start;
  system.reset();
  Status status = method.start(0, start.q, start.v);
  for (const double t : stops) {
    if (status == Status::ok) status = method.advance(t, each_step);
    std::ranges::copy(method.q(), state.q.begin());
    std::ranges::copy(method.v(), state.v.begin());
    if (status != Status::ok) break;
    if (at_stop) at_stop(state);
  }
  return {status,           method.failure(), method.time(),
          std::move(state), method.stats(),   method.limit()};
}

Simulation simulate(std::string_view integrator, System& system, const Options& options,
                    const State& start, std::span<const double> stops,
                    const std::function<void(const State&)>& at_stop,
                    const Observer& each_step) {
  const auto method = make_integrator(integrator, system, options);
  return run_method(*method, system, start, stops, at_stop, each_step);
}

Simulation simulate(std::string_view integrator, System& system, const Options& options,
                    const State& start, double t_end, const Observer& each_step) {
  return simulate(integrator, system, options, start, {&t_end, 1}, {}, each_step);
}

void conclude(Guard& guard, std::string_view integrator, const Options& options,
              Simulation& run) {
  if (run.status == Status::ok && !guard.judge(run.t, run.state.q, run.state.v)) {
    run.status = Status::fatal;
  }
  if (guard.breach()) {
    run.failure = guard.breach()->message() + ": " + remedy(integrator, options);
  }
}

Simulation simulate_guarded(Guard& guard, std::string_view integrator, System& system,
                            const Options& options, const State& start, double t_end,
                            const Observer& each_step) {
  system.reset();
  guard.start(0, start.q, start.v);
  Simulation run =
      simulate(integrator, system, options, start, t_end, [&](double t, In q, In v) {
        return guard(t, q, v) && (!each_step || each_step(t, q, v));
      });
  conclude(guard, integrator, options, run);
  return run;
}

}  // namespace tress::simulation
