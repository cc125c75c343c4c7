// What is the largest stable step of a strand, against the number of its elements, and
// which factor decides it: the solver, the Jacobian, damping or the scene?
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/numerics/stability.h"
#include "experiments/problems/formulations.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/stability_limit/stability_limit.h"
#include "simulation/files/parse.h"
#include "simulation/run/timing.h"

namespace tress::experiments::stability_limit {
namespace {

constexpr Column columns[] = {
    {"study",
     "grid (the built-in hair), tolerance (the grid with error control, and your "
     "scene), nodal (a claim about a nodal scheme), file (your scene)"},
    {"scene", "motion or load of the strand"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"solver", "linear solver of the model for S x = b"},
    {"jacobian", "terms of S (Jacobian approximation)"},
    {"modes", "unknowns per element"},
    {"elements", "number of elements"},
    {"damping", "internal friction: none, light (1e-12) or published (1e-10 kg m^3/s)"},
    {"start",
     "nodal: space, shaken in all directions by 1e-3 of its rates; plane, not out of it"},
    {"dt_max_s", "largest step such that every step tested up to it was stable"},
    {"dt_first_unstable_s", "smallest unstable step tested"},
    {"limited_by",
     "reason for instability at dt_first_unstable_s; cap: no larger step or "
     "tolerance was tried"},
    {"stable_above_s", "largest stable step above it: stability is not monotone"},
    {"dt_finest_s", "smallest step tested"},
    {"search_done",
     "false: the work was used up before smaller steps or tolerances were all tested"},
    {"runs", "steps or tolerances tested"},
    {"stable_runs", "steps tested up to dt_max_s; all were stable"},
    {"tolerance_loosest",
     "tolerance: largest tolerance over the length, from 1e-1 to 1e-5, at and "
     "below which every run tried was stable"},
    {"tolerance_tightest", "tolerance: smallest that the work was enough for"},
    {"steps_usual", "tolerance: steps at 1e-3"},
    {"work_usual", "tolerance: work at 1e-3 (max_work)"},
    {"t_end_s",
     "time simulated by a run, at least; of your scene that of the run at dt_max, up "
     "to 5 times the scene's duration"},
    {"at_1_5", "your scene: reason for instability at 1.5 times dt_max; stable: none"},
    {"energy_bound_j", "passive scenes: gain of energy that is unstable"},
    {"energy_gain_j", "largest gain of energy at dt_max"},
    {"speed_bound_m_s", "driven scenes: speed of the tip that is unstable"},
    {"speed_max_m_s", "largest speed of the tip at dt_max"},
    {"steps", "steps of the run at dt_max"},
    {"newton_iterations", "linear solves of that run"},
    {"cost_per_step_s", "wall time of a step at dt_max", true},
    {"realtime_factor", "simulated over wall time at dt_max", true},
    {"at_claim", "nodal: what broke at steps of 1e-5 s; nothing: stable"},
    {"t_claim_s", "nodal: when it ended"},
    {"energy_gain_claim_j", "nodal: largest gain of energy until then"},
    {"dt_theory_s", "nodal, explicit methods: limit over the grid's highest frequency"},
    {"dt_bending_s", "nodal, explicit methods: the same of bending alone"},
};

/// Wall time (s) of a step, over a limited number of steps so that a row stays short.
double step_cost(const StabilityCase& c, System& system, const Options& options,
                 int repeat) {
  constexpr double most_steps = 500;
  const double steps =
      std::min(most_steps, std::ceil(c.scene->t_end / options.step - 1e-9));
  const State start = perturbed_start(system);
  const double wall = time_run(repeat, [&] {
    (void)simulate(c.integrator, system, options, start, steps * options.step);
  });
  return wall / steps;
}

struct Work {
  StabilityCase which;
  Parameters parameters;
  Options options;
  StepSearch search;
  double most_work;  // of the search
  int repeat;
};

void measure(const Work& work, Row& row) {
  const StabilityCase& c = work.which;
  const auto system = c.model->make(work.parameters);
  const StabilityBounds bounds = stability_bounds(*c.scene, work.parameters, *system);
  const State start = perturbed_start(*system);
  row.set("t_end_s", c.scene->t_end);
  row.set("energy_bound_j", bounds.energy).set("speed_bound_m_s", bounds.speed);

  Options options = work.options;
  options.formulation =
      usable_formulations(find_integrator(c.integrator), *system).front();
  StabilityRuns tried(c.integrator, *system, options, start, c.scene->t_end, bounds,
                      work.most_work);
  const auto limit = find_limit(
      work.search, [&](double dt) { return tried.judge(dt); }, row);
  if (!limit) return;
  const StabilityRun& run = limit->run;
  if (bounds.energy < StabilityBounds::none) row.set("energy_gain_j", run.energy_gain);
  if (bounds.speed < StabilityBounds::none) row.set("speed_max_m_s", run.speed);
  options.step = limit->step;
  set_cost(*limit, step_cost(c, *system, options, work.repeat), row);
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, stability_settings());
  const Parameters& rows = settings.experiment();
  const StepSearch search = step_search(rows, 1e-6, line.quick ? 10 : 30);
  const auto most = [&](double quick, double usual, double full) {
    return set_or(rows, "row_work", line.quick ? quick : line.full ? full : usual);
  };
  const double row_work = most(3e6, 2e7, 1e8), ladder_work = most(3e7, 1e8, 3e8);
  if (!rows.word("scenes").empty()) {
    const auto files = listed_files(rows.word("scenes"), "scenes");
    SceneLimits how{search, row_work, set_or(rows, "horizon_s", 0.5),
                    static_cast<std::size_t>(rows.whole("strands")), line.repeat};
    std::vector<Case> all = scene_cases(line, files, how);
    how.most_work = ladder_work;
    std::ranges::move(scene_tolerance_cases(line, files, how), std::back_inserter(all));
    return all;
  }
  std::vector<Case> all;
  for (const StabilityCase& c : stability_cases(line, settings)) {
    const Work work{c,
                    c.parameters(settings),
                    settings.options(),
                    up_to(c.scene->coarsest, search),
                    row_work,
                    line.repeat};
    all.push_back(
        {c.identity(), [work](Row& row, const Deadline&) { measure(work, row); }});
  }
  std::ranges::move(tolerance_cases(line, settings, ladder_work),
                    std::back_inserter(all));
  std::ranges::move(nodal_cases(line, settings), std::back_inserter(all));
  return all;
}

void check_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_stability_claims(rows, verdicts);
  check_nodal_claims(rows, verdicts);
}

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene (several: a.toml,b.toml) instead of the built-in ones", true},
};

void answer(const CommandLine& line, const std::vector<Row>& rows) {
  print_answer(line, stability_answer(rows));
}

/// Expected results: a method without a stable step, one that needs impractically many
/// steps, and one whose work was used up. check_stability_claims() judges whether a scene
/// file has any limit.
bool finding(const Row& row) {
  return row.status() == "unstable" || row.status() == "gave_up" ||
         row.status() == "inconclusive" || row.status() == "refused";
}

constexpr Unused unused[] = {not_random};

}  // namespace
}  // namespace tress::experiments::stability_limit

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::stability_limit;
  const Experiment experiment{
      .name = "stability_limit",
      .question = "what is the largest stable step against the number of elements?",
      .example = "--elements 5,20 --integrators backward_euler --set scene=shake",
      .sizes = {"456 rows, 2.5 min", "7864 rows, hours"},
      .timed = false,
      .columns = columns,
      .settings = stability_settings(),
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .checks = check_claims,
      .finding = finding,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
