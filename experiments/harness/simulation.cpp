#include "experiments/harness/simulation.h"

namespace tress {

std::unique_ptr<System> make_model(std::string_view id, const ModelSettings& settings) {
  const ModelEntry& entry = find_model(id);
  Parameters parameters(entry.parameters, "model " + std::string(id));
  for (const auto& [key, value] : settings) parameters.set(key, value);
  return entry.make(parameters);
}

State initial_state(const System& system) {
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  State state{std::vector<double>(n), std::vector<double>(n)};
  system.initial_state(state.q, state.v);
  return state;
}

Simulation simulate(std::string_view integrator, System& system, const Options& options,
                    const State& start, double t_end, const Observer& each_step) {
  const auto method = make_integrator(integrator, system, options);
  Status status = method->start(0, start.q, start.v);
  if (status == Status::ok) status = method->advance(t_end, each_step);
  const In q = method->q(), v = method->v();
  return {status,
          method->failure(),
          method->time(),
          {{q.begin(), q.end()}, {v.begin(), v.end()}},
          method->stats()};
}

}  // namespace tress
