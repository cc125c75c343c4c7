// What does accuracy cost in time, per integrator? Error at the end of a run against its
// wall time, from loose to tight, on problems with exact, published or doubly computed
// references.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "experiments/problems/formulations.h"
#include "experiments/problems/problems.h"
#include "experiments/problems/reference.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_problems.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/work_precision/work_precision_series.h"
#include "simulation/run/simulation.h"
#include "simulation/run/timing.h"

namespace tress {
namespace {

constexpr Column columns[] = {
    {"scene", "the problem"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"formulation", "how constraints enter"},
    {"dt_s", "fixed step"},
    {"rtol", "relative tolerance, adaptive methods"},
    {"elements", "coordinates of the problem; of a strand, its elements"},
    {"solver", "linear solver in use; of a strand, the model's own"},
    {"error_kind",
     "time: against the same equations integrated to convergence; total: against the "
     "continuous body"},
    {"error_rel", "largest error of the compared positions over their scale"},
    {"scd", "significant correct digits, -log10 of the largest relative error"},
    {"reference_gap", "disagreement of the two references, same norm"},
    {"below_reference", "error below ten times that gap: not to be trusted"},
    {"wall_s", "median wall time of the run", true},
    {"wall_s_per_sim_s", "the same per simulated second", true},
    {"steps", "accepted steps"},
    {"rejected", "rejected steps"},
    {"residuals", "residual or acceleration evaluations"},
    {"linearizations", "matrices built and factored"},
    {"solves", "linear solves"},
    {"order_fit",
     "slope of log error over the finest points: against log step; total errors at the "
     "finest step against log element length"},
    {"pareto",
     "no other run of the scene and kind of error is both faster and more accurate"},
};

constexpr double quick_work = 1e7;  // of a run

struct Work {
  const Problem& problem;
  std::string_view integrator;
  std::string_view solver;  // empty: the problem's model has one
  Options options;
  int repeat;

  Row identity(const IntegratorEntry& entry) const {
    Row row;
    row.set("scene", problem.name).set("model", problem.model);
    row.set("integrator", integrator).set("formulation", name(options.formulation));
    if (problem.elements > 0) {
      row.set("error_kind", problem.error_kind).set("elements", problem.elements);
    }
    if (!solver.empty()) row.set("solver", solver);
    return entry.adaptive ? row.set("rtol", options.rtol) : row.set("dt_s", options.step);
  }
};

void measure(const Work& work, Row& row) {
  const Problem& problem = work.problem;
  std::optional<ProblemRun> run;
  const double wall = time_run(work.repeat, [&] {
    run = run_problem(problem, work.integrator, work.options, work.solver);
  });
  const Stats& stats = run->end.stats;
  if (problem.elements == 0) row.set("elements", run->end.state.q.size());
  if (work.solver.empty()) row.set("solver", stats.solver);
  row.set("steps", stats.steps).set("rejected", stats.rejected);
  row.set("residuals", stats.residuals).set("linearizations", stats.linearizations);
  row.set("solves", stats.solves);
  if (run->end.status != Status::ok) {
    row.failed("solver_error", run->end.failure);
    return;
  }
  const double error = run->error.relative;
  if (!(error <= 10)) {
    row.failed("diverged", "error above ten times the scale of the problem");
    return;
  }
  row.set("error_kind", problem.error_kind).set("error_rel", error);
  row.set("scd", run->error.scd);
  row.set("reference_gap", problem.reference_gap);
  row.set("below_reference", error < ReferenceGap::margin * problem.reference_gap);
  row.set("wall_s", wall).set("wall_s_per_sim_s", wall / problem.t_end);
}

/// The formulations a table of manageable size shows: the method's own best. --full: all.
std::vector<Formulation> shown(const IntegratorEntry& entry, System& system, bool full) {
  std::vector<Formulation> list = usable_formulations(entry, system);
  if (!full && list.size() > 1) list.erase(list.begin() + 1, list.end());
  return list;
}

/// Those of the problem's model that this integrator is tried with.
std::vector<std::string_view> solvers(const Problem& problem,
                                      std::string_view integrator) {
  if (problem.solvers.empty()) return {""};
  const bool all =
      std::ranges::find(problem.comparing, integrator) != problem.comparing.end();
  return all ? problem.solvers : std::vector{problem.solvers.front()};
}

bool tried(const Problem& problem, std::string_view integrator) {
  return problem.integrators.empty() ||
         std::ranges::find(problem.integrators, integrator) != problem.integrators.end();
}

std::vector<Case> cases(const CommandLine& line) {
  const Options base = Settings(line, {}).options();
  std::vector<Case> all;
  const auto add = [&](const Problem& problem) {
    if (!wanted(line.models, problem.model)) return;
    // Half of the sizes show the order.
    constexpr int between[] = {7, 14, 28};
    if (line.quick && std::ranges::find(between, problem.elements) != std::end(between)) {
      return;
    }
    const auto system = problem.make();
    for (const IntegratorEntry& entry : integrators()) {
      if (!wanted(line.integrators, entry.id) || !tried(problem, entry.id)) continue;
      for (const Formulation formulation : shown(entry, *system, line.full)) {
        for (const std::string_view solver : solvers(problem, entry.id)) {
          // The finest steps add nothing to a total error.
          const bool total = problem.error_kind == "total";
          const int points = line.full    ? (total ? 8 : 10)
                             : line.quick ? (total ? 3 : 6)
                                          : (total ? 5 : 7);
          for (int level = 0; level < points; ++level) {
            Work work{problem, entry.id, solver, base, line.repeat};
            work.options.formulation = formulation;
            if (line.quick && base.max_work == 0) work.options.max_work = quick_work;
            if (entry.adaptive) {
              work.options.rtol = work.options.atol = std::pow(10, -3 - level);
            } else {
              work.options.step = problem.coarse_step / std::pow(2, level);
            }
            all.push_back({work.identity(entry),
                           [work](Row& row, const auto&) { measure(work, row); }});
          }
        }
      }
    }
  };
  for (const Problem& problem : problems()) add(problem);
  // Their references take some seconds.
  if (std::ranges::any_of(strand_models(), [&line](const ModelEntry* model) {
        return wanted(line.models, model->id);
      })) {
    for (const Problem& problem : strand_problems()) add(problem);
  }
  return all;
}

/// Most correct digits that a method has on a problem; none: it was not run.
std::optional<double> best_scd(const std::vector<Row>& rows, std::string_view scene,
                               std::string_view integrator) {
  std::optional<double> best;
  for (const Row& row : rows) {
    if (row.text("scene") != scene || row.text("integrator") != integrator) continue;
    best = std::max(best.value_or(0), row.ok() ? row.number("scd") : 0);
  }
  return best;
}

/// Six digits on a problem by `least` methods at least. Of these it takes that many to
/// show it, and only if all of them were run have they not.
struct DigitsClaim {
  std::string_view claim, scene;
  std::vector<std::string_view> by;
  int least;
};

void check_digits(const std::vector<Row>& rows, const DigitsClaim& claim,
                  Verdicts& verdicts) {
  int enough = 0;
  bool complete = true;
  for (const std::string_view id : claim.by) {
    const auto digits = best_scd(rows, claim.scene, id);
    complete = complete && digits;
    if (digits.value_or(0) >= 6) ++enough;
  }
  verdicts.check_found(std::string(claim.claim), enough >= claim.least, complete, enough);
}

void check_order(const std::vector<Row>& rows, std::string_view model,
                 Verdicts& verdicts) {
  const std::string claim =
      std::string(model) + ": total error falls at order 2 in element length";
  const auto total = std::ranges::find_if(rows, [&](const Row& row) {
    return row.text("model") == model && row.text("error_kind") == "total" &&
           row.has("order_fit");
  });
  if (total == rows.end()) {
    verdicts.not_judged(claim);
    return;
  }
  const double order = total->number("order_fit");
  verdicts.check(claim, order >= 1.8, order);
}

void check(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_digits(rows,
               {"Andrews' squeezer: 6 correct digits from ida or an implicit method",
                "andrews_squeezer",
                {"ida", "generalized_alpha", "newmark", "bdf2"},
                1},
               verdicts);
  check_digits(rows,
               {"Beam: 6 correct digits from two integrators",
                "beam",
                {"ida", "rk4", "gsl_rk8pd", "gsl_msadams", "cvode_adams"},
                2},
               verdicts);
  for (const std::string_view model : {"super_helix", "articulated_chain"}) {
    check_order(rows, model, verdicts);
  }
}

/// A step or tolerance too loose for the method is where its curve ends, not a mistake.
bool finding(const Row&) { return true; }

constexpr Unused unused[] = {{"elements", "its problems have the sizes of their sources"},
                             not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "work_precision",
      .question = "what does accuracy cost in time, per integrator?",
      .example = "--models beam --integrators cvode_bdf,arkode_dirk",
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .derive = add_series_columns,
      .checks = check,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
