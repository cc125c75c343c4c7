// What does each strand model cost at the same accuracy, and what does it lose on the
// way? For every model and integrator the cheapest elements and step whose tip is within
// 1 % of the continuous rod, with what lengths, momentum and energy do in that run.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/numerics/cheapest_run.h"
#include "experiments/numerics/drift_monitor.h"
#include "experiments/numerics/momentum_drift.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/model_variants.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "models/strand/strand_parameters.h"
#include "simulation/run/guard.h"

namespace tress {
namespace {

constexpr Column columns[] = {
    {"scene", "release (clamped, falls) or flight (free, curved, spinning, no gravity)"},
    {"model", "catalogue id"},
    {"variant", "how it keeps its length, where there is a choice"},
    {"integrator", "method"},
    {"formulation", "how constraints enter"},
    {"target_error_rel", "wanted tip error: root mean square over the run, over length"},
    {"elements", "of the cheapest run that meets it"},
    {"dt_s", "of that run"},
    {"tip_error_rel", "of that run, against the continuous rod"},
    {"reference_gap", "disagreement of the two references of the rod"},
    {"wall_s_per_sim_s", "median wall time of that run per simulated second", true},
    {"cost_per_step_s", "the same per step", true},
    {"length_error_rel", "largest relative change of length of an element in that run"},
    {"linear_error_rel", "flight: largest change of linear momentum, over m g 0.1 s"},
    {"angular_error_rel", "flight: largest change of angular momentum, over itself"},
    {"energy_error_rel",
     "largest change of mechanical energy, over the largest kinetic energy"},
    {"unknowns", "coordinates and multipliers"},
    {"nonzeros", "of the matrix of a step; unknowns squared where it is dense"},
};

constexpr double t_end = 0.25, length = 0.1;  // s, m
constexpr int samples = 5;
constexpr int ladder[] = {3, 5, 7, 10, 14, 20, 28, 40, 56};
constexpr double coarsest = 1 / 60.0, finest = 1e-4;  // s
constexpr double quick_work = 1e7, usual_work = 1e9;  // of a row's search
constexpr std::string_view usual[] = {"semi_implicit_euler",
                                      "implicit_midpoint",
                                      "generalized_alpha",
                                      "predictor_corrector",
                                      "xpbd",
                                      "rattle",
                                      "backward_euler"};
constexpr std::size_t usual_quick = 5;  // the first of them
// N s of the momentum that gravity gives a hair in 0.1 s: what a momentum error is
// compared with where there is none at the start.
constexpr double fall = 0.981;  // m/s

struct Scene {
  std::string_view name;
  ModelSettings settings;
  std::string_view root;  // the word a model must know
  RodModels rod;
};

/// Nothing twists it.
ModelSettings falling() {
  ModelSettings all = find_strand_scene("release").settings;
  all.emplace_back("modes", "bend");
  return all;
}

const std::array scenes{
    Scene{"release", falling(), "fixed", clamped_rod},
    Scene{"flight",
          {{"root", "free"}, {"gravity_m_s2", "0"}, {"natural_curvature_1_m", "20"}},
          "free",
          free_rod}};

struct Work {
  const Scene* scene;
  ModelVariant variant;
  Parameters parameters;
  std::string_view integrator;
  Options options;
  double target;
  TipReference reference;
  int repeat;
  double most_work;

  Parameters with(int elements) const {
    Parameters p = parameters;
    p.set("elements", std::to_string(elements));
    return p;
  }
  std::unique_ptr<System> make(int elements) const {
    return variant.model->make(with(elements));
  }
  Options at(double dt) const {
    Options all = options;
    all.step = dt;
    return all;
  }
};

/// A run whose energy sits in stretching that no hair has meets no target, wherever its
/// tip may be.
CheapRun attempt(const Work& work, int elements, double dt) {
  const auto system = work.make(elements);
  Guard guard(*system, guarded_strands(*work.variant.model, work.with(elements)));
  const TipRun run =
      run_tip(work.integrator, *system, work.at(dt), t_end, samples, 0, &guard);
  const double error = run.status == Status::ok
                           ? tip_error(run.tip, work.reference.tip, length)
                           : std::numeric_limits<double>::infinity();
  return {elements, dt, error, total_work(run.stats, run.unknowns)};
}

/// What the run does to lengths, momentum and energy.
void observe(const Work& work, const CheapRun& best, Row& row) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto system = work.make(best.elements);
  const State start = initial_state(*system);
  DriftMonitor drift(*system, start.q, start.v, never);
  std::optional<MomentumDrift> momentum;
  if (work.scene->root == "free") {
    momentum.emplace(*system->energetics(), start.q, start.v);
  }
  const Simulation run = simulate(work.integrator, *system, work.at(best.dt), start,
                                  t_end, [&](double t, In q, In v) {
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
  row.set("linear_error_rel",
          momentum->linear() / (strand(work.parameters).mass() * fall));
  row.set("angular_error_rel", momentum->angular() / momentum->angular_start());
}

void measure(const Work& work, Row& row) {
  const auto [best, complete] = cheapest_run(
      {work.target, ladder, coarsest, finest, work.most_work},
      [&work](int elements, double dt) { return attempt(work, elements, dt); });
  if (!best) {
    row.failed("not_met", complete ? "no run within the target"
                                   : "no run within the target in the work of a row");
    return;
  }
  const auto system = work.make(best->elements);
  const Layout layout = system->layout();
  const int unknowns = layout.coordinates + layout.constraints;
  row.set("elements", best->elements).set("dt_s", best->dt);
  row.set("tip_error_rel", best->error).set("reference_gap", work.reference.gap);
  row.set("unknowns", unknowns);
  SparseForm* sparse = system->sparse_form();
  int nonzeros = sparse != nullptr ? sparse->pattern().nonzeros() : unknowns * unknowns;
  if (layout.constraints > 0) {
    nonzeros += 2 * system->constraint_form()->pattern().nonzeros();
  }
  row.set("nonzeros", nonzeros);
  const double wall =
      run_tip(work.integrator, *system, work.at(best->dt), t_end, samples, work.repeat)
          .wall_s;
  row.set("wall_s_per_sim_s", wall / t_end);
  row.set("cost_per_step_s", wall / std::ceil(t_end / best->dt - 1e-9));
  observe(work, *best, row);
}

Parameters parameters(const Settings& settings, const Scene& scene,
                      const ModelVariant& variant) {
  Parameters p = settings.parameters(*variant.model);
  set_known(p, scene.settings);
  set_known(p, variant.settings);
  return p;
}

TipReference rod(const Settings& settings, const Scene& scene) {
  const MakeStrand make = [&](std::string_view model, int elements) {
    Parameters p = parameters(settings, scene, {&find_model(model), {}, ""});
    p.set("elements", std::to_string(elements));
    return find_model(model).make(p);
  };
  return converged_rod(make, {t_end, samples, length}, scene.rod);
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, {});
  std::vector<Case> all;
  for (const Scene& scene : scenes) {
    const TipReference reference = line.dry_run ? TipReference{} : rod(settings, scene);
    for (const ModelVariant& variant : length_variants()) {
      const ModelEntry& model = *variant.model;
      if (!wanted(line.models, model.id)) continue;
      if (!has_word(model, "root", scene.root)) continue;
      const Parameters p = parameters(settings, scene, variant);
      std::unique_ptr<System> system;
      try {
        system = model.make(p);
      } catch (const InputError&) {
        continue;  // a model without curls
      }
      for (std::size_t i = 0; i < std::size(usual); ++i) {
        const bool chosen = !line.integrators.empty();
        if (chosen ? !wanted(line.integrators, usual[i]) : line.quick && i >= usual_quick)
          continue;
        const auto formulations = usable_formulations(find_integrator(usual[i]), *system);
        if (formulations.empty()) continue;
        Options options = settings.options();
        options.formulation = formulations.front();
        const Work work{&scene,    variant,     p,
                        usual[i],  options,     0.01,
                        reference, line.repeat, line.quick ? quick_work : usual_work};
        Row identity;
        identity.set("scene", scene.name).set("model", model.id);
        if (!variant.words.empty()) identity.set("variant", variant.words);
        identity.set("integrator", usual[i]);
        identity.set("formulation", name(options.formulation));
        identity.set("target_error_rel", work.target);
        all.push_back(
            {identity, [work](Row& row, const Deadline&) { measure(work, row); }});
      }
    }
  }
  return all;
}

void check_momentum(const std::vector<Row>& rows, Verdicts& verdicts) {
  bool any = false;
  for (const Row& row : rows) {
    if (row.text("scene") != "flight" || !row.ok()) continue;
    if (row.text("integrator") != "implicit_midpoint") continue;
    any = true;
    verdicts.check("flight, " + std::string(row.text("model")) +
                       ", implicit_midpoint: keeps angular momentum better than its tip",
                   row.number("angular_error_rel") < row.number("target_error_rel"),
                   row.number("angular_error_rel"));
  }
  if (!any) {
    verdicts.not_judged(
        "flight, implicit_midpoint: keeps angular momentum better than its tip");
  }
}

/// That a method does not get there is an answer.
bool finding(const Row&) { return true; }

constexpr Unused unused[] = {{"elements", "the cheapest number is what it looks for"},
                             not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "equal_accuracy",
      .question =
          "what does each strand model cost at the same accuracy, and what does "
          "it lose?",
      .example = "--models der,super_helix --integrators implicit_midpoint",
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .checks = check_momentum,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
