#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "contract/forms/sparse_form.h"
#include "contract/input_error.h"
#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/cost_of_accuracy/trial.h"
#include "experiments/cost_of_accuracy/trial_scene.h"
#include "experiments/numerics/cheapest_run.h"
#include "experiments/numerics/drift_monitor.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_reference.h"
#include "simulation/run/guard.h"
#include "simulation/run/simulation.h"
#include "simulation/scene/scene_tables.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

constexpr double target = 0.01;
constexpr int ladder[] = {3, 5, 7, 10, 14, 20, 28, 40, 56};
constexpr double coarsest = 1 / 60.0, finest = 1e-4;  // s
constexpr double quick_work = 5e6, usual_work = 1e9;  // per search of a row
constexpr std::string_view usual[] = {"linearly_implicit_euler",
                                      "implicit_midpoint",
                                      "generalized_alpha",
                                      "predictor_corrector",
                                      "xpbd",
                                      "rattle",
                                      "backward_euler"};
constexpr std::size_t usual_quick = 5;  // the first of them
// m/s that gravity gives a hair in 0.1 s: the scale for changes of linear momentum, which
// may be zero at the start.
constexpr double fall = 0.981;

/// The compared scene with its reference.
struct Compared {
  Scene scene;
  TipSampling sampling;
  TipReference reference;
  bool free() const { return scene.strands.front().free_root.has_value(); }
};

std::unique_ptr<System> system_of(const Scene& scene) {
  return scene.model->on_strand(scene.strands.front(), scene.model_options,
                                make_effects(scene));
}

/// One method on it; the scene has its file's discretisation.
struct MethodWork {
  std::shared_ptr<const Compared> compared;
  Method method;
  std::vector<int> elements;  // to try, ascending
  int repeat;
  double most_work;

  Scene with(int count) const {
    return with_elements(with_method(compared->scene, method), count);
  }
  Options at(double dt, double limit = 0) const {
    Options options;
    options.formulation = method.formulation;
    options.step = dt;
    options.max_work = limit;
    return options;
  }
};

/// A run whose energy sits in unphysical stretching meets no target, wherever its tip may
/// be.
CheapRun attempt(const MethodWork& work, int elements, double dt, double most_work) {
  const Scene scene = work.with(elements);
  const auto [t_end, samples, length] = work.compared->sampling;
  const auto system = system_of(scene);
  Guard guard(*system, {guarded_strand(scene.strands.front(), make_effects(scene))});
  const TipRun run = run_tip(work.method.integrator, *system, work.at(dt, most_work),
                             t_end, samples, 0, &guard);
  const double error = run.status == Status::ok
                           ? tip_error(run.tip, work.compared->reference.tip, length)
                           : never;
  return {elements, dt, error, total_work(run.stats, run.unknowns)};
}

/// Measures the run's errors in lengths, momentum and energy.
void observe(const MethodWork& work, const CheapRun& best, Row& row) {
  const Scene scene = work.with(best.elements);
  const auto system = system_of(scene);
  const State start = initial_state(*system);
  DriftMonitor drift(*system, start.q, start.v, never);
  std::optional<MomentumDrift> momentum;
  if (work.compared->free()) momentum.emplace(*system->energetics(), start.q, start.v);
  const Simulation run =
      simulate(work.method.integrator, *system, work.at(best.dt), start,
               work.compared->sampling.t_end, [&](double t, In q, In v) {
                 if (momentum) momentum->see(t, q, v);
                 return drift(t, q, v);
               });
  if (run.status != Status::ok) {
    row.failed("solver_error", run.failure);
    return;
  }
  row.set("length_error_rel", drift.length_error());
  row.set("energy_error_rel", drift.energy_drift());
  if (!momentum) return;
  row.set("linear_error_rel", momentum->linear() / (scene.strands.front().mass() * fall));
  row.set("angular_error_rel", momentum->angular() / momentum->angular_start());
}

/// Unknowns and nonzeros of a step's matrix.
void set_size(System& system, Row& row) {
  const Layout layout = system.layout();
  const int unknowns = layout.coordinates + layout.constraints;
  SparseForm* sparse = system.sparse_form();
  int nonzeros = sparse != nullptr ? sparse->pattern().nonzeros() : unknowns * unknowns;
  if (layout.constraints > 0) {
    nonzeros += 2 * system.constraint_form()->pattern().nonzeros();
  }
  row.set("unknowns", unknowns).set("nonzeros", nonzeros);
}

void measure(const MethodWork& work, Row& row) {
  const auto [best, complete] =
      cheapest_run({target, work.elements, coarsest, finest, work.most_work},
                   [&work](int elements, double dt, double most_work) {
                     return attempt(work, elements, dt, most_work);
                   });
  if (!best) {
    row.failed("not_met", complete ? "no run within the target"
                                   : "no run within the target in the work of a row");
    return;
  }
  const auto [t_end, samples, length] = work.compared->sampling;
  const auto system = system_of(work.with(best->elements));
  row.set("elements", best->elements).set("dt_s", best->dt);
  row.set("error_rel", best->error).set("horizon_s", t_end);
  row.set("reference_gap", work.compared->reference.gap);
  set_size(*system, row);
  const double wall = run_tip(work.method.integrator, *system, work.at(best->dt), t_end,
                              samples, work.repeat)
                          .wall_s;
  row.set("wall_s_per_sim_s", wall / t_end);
  row.set("cost_per_step_s", wall / std::ceil(t_end / best->dt - 1e-9));
  observe(work, *best, row);
}

/// The non-default options of the scene's model, for every model with these options.
ModelSettings own_options(const Scene& scene) {
  ModelSettings all;
  for (const Parameter& p : model_table_parameters(*scene.model)) {
    const std::string text = scene.model_options.text(p.name);
    if (p.name != "id" && text != p.default_text()) all.emplace_back(p.name, text);
  }
  return all;
}

TipReference rod(const Compared& compared) {
  const MakeStrand make = [&](std::string_view id, int elements) {
    const ModelEntry& model = find_model(id);
    const Method method{{&model, known_to(model, own_options(compared.scene)), {}}};
    return system_of(with_elements(with_method(compared.scene, method), elements));
  };
  return converged_rod(make, compared.sampling, compared.free() ? free_rod : clamped_rod);
}

std::shared_ptr<const Compared> read(const CommandLine& line, const std::string& file) {
  Compared made{read_open_scene(file), {}, {}};
  const Scene& scene = made.scene;
  if (scene.strands.size() != 1) {
    throw InputError("several strands, where every model is compared on one", file,
                     "give a scene of one [strand]");
  }
  made.sampling = {scene.duration, static_cast<int>(scene.last_frame()),
                   scene.strands.front().length()};
  if (!line.dry_run) made.reference = rod(made);
  return std::make_shared<const Compared>(std::move(made));
}

std::vector<std::string_view> integrators_of(const CommandLine& line) {
  std::vector<std::string_view> all;
  for (std::size_t i = 0; i < std::size(usual); ++i) {
    const bool chosen = line.integrators.empty() ? !line.quick || i < usual_quick
                                                 : wanted(line.integrators, usual[i]);
    if (chosen) all.push_back(usual[i]);
  }
  return all;
}

/// Null where the model cannot represent the scene: one without curls, or a free root.
std::unique_ptr<System> system_or_none(const Scene& scene, const Method& method) {
  try {
    return system_of(with_method(scene, method));
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace

std::vector<Case> method_cases(const CommandLine& line, const std::string& file) {
  const auto compared = read(line, file);
  const std::vector<int> elements =
      line.elements.empty() ? std::vector<int>(std::begin(ladder), std::end(ladder))
                            : line.elements;
  std::vector<Case> all;
  for (const ModelVariant& variant : length_variants()) {
    const ModelEntry& model = *variant.model;
    if (!wanted(line.models, model.id)) continue;
    Method method{{&model, known_to(model, own_options(compared->scene)), {}}};
    method.options.insert(method.options.end(), variant.settings.begin(),
                          variant.settings.end());
    const auto system = system_or_none(compared->scene, method);
    if (system == nullptr) continue;
    for (const std::string_view integrator : integrators_of(line)) {
      const auto formulations = usable_formulations(find_integrator(integrator), *system);
      if (formulations.empty()) continue;
      method.integrator = integrator;
      method.formulation = formulations.front();
      Row identity;
      identity.set("scene", compared->scene.name).set("kind", "method");
      identity.set("target_error_rel", target);
      set_method(method, identity);
      const MethodWork work{compared, method, elements, line.repeat,
                            line.quick ? quick_work : usual_work};
      all.push_back(
          {identity, [work](Row& row, const Deadline&) { measure(work, row); }});
    }
  }
  return all;
}

void check_method_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto of_methods = [](const Row& row) { return row.text("kind") == "method"; };
  if (std::ranges::none_of(rows, of_methods)) return;
  bool any = false;
  for (const Row& row : rows) {
    if (!of_methods(row) || !row.has("angular_error_rel")) continue;
    if (row.text("integrator") != "implicit_midpoint") continue;
    any = true;
    verdicts.check(std::string(row.text("scene")) + ", " +
                       std::string(row.text("model")) +
                       ", implicit_midpoint: keeps angular momentum better than its tip",
                   row.number("angular_error_rel") < row.number("target_error_rel"),
                   row.number("angular_error_rel"));
  }
  if (any) return;
  verdicts.not_judged(
      "flight, implicit_midpoint: keeps angular momentum better than its tip");
}

}  // namespace tress::experiments::cost_of_accuracy
