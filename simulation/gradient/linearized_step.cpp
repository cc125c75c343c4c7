#include "simulation/gradient/linearized_step.h"

#include <fmt/format.h>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "integrators/gradient/gradient_run.h"
#include "integrators/gradient/step_memory.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {
namespace {

using integrators::GradientRun;
using integrators::RunParameter;

void check_step(const Scene& scene, System& system) {
  check_derivatives(scene);
  const std::string place = gradient_place(scene);
  if (integrators::remembers_steps(scene.integrator)) {
    std::vector<std::string_view> able;
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      if (entry.stages > 0 && !integrators::remembers_steps(entry.id)) {
        able.push_back(entry.id);
      }
    }
    throw InputError(
        fmt::format("a step of {} depends on the steps before, not on (q, v) alone",
                    scene.integrator),
        place, fmt::format("use one of: {}", fmt::join(able, ", ")));
  }
  refuse_if(system.layout().constraints > 0,
            "no matrices of a step of a model with constraints, whose coordinates do not "
            "change independently",
            place, "use a model without constraints");
}

/// The state of the scene's own run at t. Returns why it does not get there.
std::string run_to(const Scene& scene, System& system, double t, GradientRun::State& at) {
  at.q.resize(static_cast<std::size_t>(system.layout().coordinates));
  at.v.resize(at.q.size());
  system.initial_state(at.q, at.v);
  system.accept(0, at.q, at.v);
  const auto run = integrators::make_integrator(
      scene.integrator, system, options_beside_supports(system, scene.options));
  Status s = run->start(0, at.q, at.v);
  if (s == Status::ok && t > 0) s = run->advance(t);
  if (s != Status::ok) return run->failure();
  at.t = t;
  at.q.assign(run->q().begin(), run->q().end());
  at.v.assign(run->v().begin(), run->v().end());
  at.memory = system.memory();
  return {};
}

}  // namespace

LinearizedStep linearized_step(const Scene& scene, std::size_t strand, double t,
                               double step, std::span<const SceneParameter> parameters) {
  const auto system = system_of(scene, strand);
  check_step(scene, *system);
  GradientRun::State from;
  LinearizedStep all;
  all.t = t;
  all.unfinished = run_to(scene, *system, t, from);
  if (!all.unfinished.empty()) return all;
  const std::size_t n = from.q.size(), states = 2 * n;
  // Columns of the state are those of parameters that change the start alone.
  std::vector<RunParameter> columns(
      states, [&](double) { return exact_system_of(scene, strand); });
  const auto varied = run_parameters(scene, strand, parameters);
  columns.insert(columns.end(), varied.begin(), varied.end());
  from.dq.resize(columns.size() * n);
  from.dv.resize(from.dq.size());
  for (std::size_t i = 0; i < n; ++i) {
    from.dq[i * n + i] = 1;
    from.dv[(n + i) * n + i] = 1;
  }
  GradientRun::Method method{.id = scene.integrator,
                             .options = options_beside_supports(*system, scene.options)};
  method.options.tolerance = 0;
  method.options.step = step;
  method.forces = known_forces(scene);
  GradientRun run(*system, exact_system_of(scene, strand), columns, method);
  Status s = run.start(from);
  if (s == Status::ok) s = run.advance(t + step);
  if (s != Status::ok) {
    all.unfinished = run.failure();
    return all;
  }
  all.t_next = run.time();
  all.q = from.q;
  all.v = from.v;
  all.q_next.assign(run.q().begin(), run.q().end());
  all.v_next.assign(run.v().begin(), run.v().end());
  all.by_state.resize(states * states);
  all.by_parameters.resize(states * parameters.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const bool of_state = k < states;
    const std::size_t j = of_state ? k : k - states;
    const std::size_t width = of_state ? states : parameters.size();
    const double measure = of_state ? 1 : parameters[j].measure;
    std::vector<double>& matrix = of_state ? all.by_state : all.by_parameters;
    for (std::size_t i = 0; i < n; ++i) {
      matrix[i * width + j] = run.dq(k)[i] / measure;
      matrix[(n + i) * width + j] = run.dv(k)[i] / measure;
    }
  }
  return all;
}

}  // namespace tress::simulation
