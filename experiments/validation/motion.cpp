#include "experiments/validation/motion.h"

#include <memory>
#include <stdexcept>
#include <string>

#include "experiments/harness/formulations.h"
#include "experiments/harness/simulation.h"
#include "models/effects/gravity.h"
#include "models/input_error.h"

namespace tress {

Effects weight() { return {std::make_shared<Gravity>(Vec{0, 0, -earth_gravity})}; }

Track track(std::string_view integrator, System& system, double dt, double t_end,
            const Look& look, const std::function<bool(double value)>& enough) {
  const auto formulations = usable_formulations(find_integrator(integrator), system);
  if (formulations.empty()) {
    throw InputError("cannot drive this model", std::string(integrator),
                     "use another integrator");
  }
  Options options;
  options.formulation = formulations.front();
  options.step = dt;
  Track seen;
  bool stopped = false;
  const Observer each_step = [&](double t, In q, In v) {
    seen.t.push_back(t);
    seen.value.push_back(look(t, q, v));
    stopped = enough && enough(seen.value.back());
    return !stopped;
  };
  const State start = initial_state(system);
  system.reset();
  each_step(0, start.q, start.v);
  const Simulation run = simulate(integrator, system, options, start, t_end, each_step);
  if (run.status != Status::ok && !stopped) throw std::runtime_error(run.failure);
  return seen;
}

Look place(System& system, int point, int axis) {
  MaterialPoints& points = *system.material_points();
  const int i = point < 0 ? points.count() + point : point;
  const auto at = static_cast<std::size_t>(3 * i + axis);
  return [&points, at,
          x = std::vector<double>(3 * static_cast<std::size_t>(points.count()))](
             double t, In q, In) mutable {
    points.positions(t, q, x);
    return x[at];
  };
}

Look kinetic(System& system) {
  return [&system](double t, In q, In v) {
    return system.energetics()->energy(t, q, v).kinetic;
  };
}

}  // namespace tress
