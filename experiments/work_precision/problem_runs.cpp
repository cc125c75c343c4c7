#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "experiments/problems/formulations.h"
#include "experiments/problems/problems.h"
#include "experiments/work_precision/work_precision.h"
#include "simulation/run/timing.h"

namespace tress::experiments::work_precision {
namespace {

constexpr double quick_work = 5e6;  // per run
constexpr int usual_order = 2;      // the default maximum of cvode_bdf

struct Work {
  const Problem& problem;
  std::string_view integrator;
  bool adaptive;
  Options options;
  int repeat;

  Row identity() const {
    Row row;
    row.set("scene", problem.name).set("model", problem.model);
    row.set("integrator", integrator).set("formulation", name(options.formulation));
    if (options.max_order > 0) row.set("max_order", options.max_order);
    set_drive(options, adaptive, row);
    return row;
  }
};

void measure(const Work& work, Row& row) {
  const Problem& problem = work.problem;
  std::optional<ProblemRun> run;
  const double wall = time_run(
      work.repeat, [&] { run = run_problem(problem, work.integrator, work.options); });
  const Stats& stats = run->end.stats;
  row.set("elements", run->end.state.q.size()).set("solver", stats.solver);
  set_counts(stats, row);
  if (run->end.status != Status::ok) {
    row.failed(run->end.limit == Limit::work ? "gave_up" : "solver_error",
               run->end.failure);
    return;
  }
  const double error = run->error.relative;
  if (!(error <= 10)) {
    row.failed("diverged", "error above ten times the scale of the problem");
    return;
  }
  row.set("error_kind", "time").set("scd", run->error.scd);
  set_error(error, problem.reference_gap, row);
  set_achieved(run->error.of_body, work.options, row);
  set_time(wall, problem.t_end, row);
}

/// The formulations shown in a table of manageable size: the method's preferred one.
/// --full: all.
std::vector<Formulation> shown(const IntegratorEntry& entry, System& system, bool full) {
  std::vector<Formulation> list = usable_formulations(entry, system);
  if (!full && list.size() > 1) list.erase(list.begin() + 1, list.end());
  return list;
}

/// Builds the list according to the user's options.
class List {
 public:
  List(const CommandLine& line, const Settings& settings)
      : line_(line),
        base_(settings.options()),
        chosen_order_(settings.chosen("max_order")) {}

  void add(const Problem& problem) {
    const auto system = problem.make();
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      if (!wanted(line_.integrators, entry.id)) continue;
      const std::vector<Formulation> all = shown(entry, *system, line_.full);
      for (const Formulation formulation : all) add(problem, entry, formulation);
      if (entry.error_controlled) add_tolerances(problem, entry, *system);
    }
  }

  std::vector<Case> cases() { return std::move(all_); }

 private:
  Work work_of(const Problem& problem, const IntegratorEntry& entry,
               Formulation formulation) const {
    Work work{problem, entry.id, entry.adaptive, base_, line_.repeat};
    work.options.formulation = formulation;
    if (line_.quick && base_.max_work == 0) work.options.max_work = quick_work;
    return work;
  }

  void add(const Problem& problem, const IntegratorEntry& entry,
           Formulation formulation) {
    Work work = work_of(problem, entry, formulation);
    const int points = line_.full ? 10 : line_.quick ? 6 : 7;
    const bool orders =
        problem.name == "beam" && entry.id == "cvode_bdf" && !chosen_order_;
    if (!orders) {
      for (int level = 0; level < points; ++level) rung(work, level);
      return;
    }
    // These rows are to show that high orders are slow.
    work.options.max_work = base_.max_work;
    for (int order = 1; order <= 5; ++order) {
      work.options.max_order = order;
      const int last = order == usual_order ? points - 1 : line_.full ? 5 : 3;
      for (double level = 0; level <= last; level += line_.quick ? 1 : 0.5) {
        rung(work, level);
      }
    }
  }

  void add_tolerances(const Problem& problem, const IntegratorEntry& entry,
                      System& system) {
    for (const double tolerance : tolerances(line_)) {
      const auto formulation = preferred_formulation(entry, system, tolerance);
      if (!formulation) return;
      Work work = work_of(problem, entry, *formulation);
      work.options.tolerance = tolerance;
      put(work);
    }
  }

  void rung(Work work, double level) {
    work.options.tolerance = 0;
    if (work.adaptive) {
      work.options.rtol = work.options.atol = std::pow(10, -3 - level);
    } else {
      work.options.step = work.problem.coarse_step / std::pow(2, level);
    }
    put(work);
  }

  void put(const Work& work) {
    all_.push_back(
        {work.identity(), [work](Row& row, const auto&) { measure(work, row); }});
  }

  const CommandLine& line_;
  Options base_;
  bool chosen_order_;
  std::vector<Case> all_;
};

}  // namespace

std::vector<Case> problem_runs(const CommandLine& line, const Settings& settings) {
  // Options that only apply to strands.
  const bool of_strands = !line.elements.empty() || !keeps(settings, "error", "time") ||
                          !keeps(settings, "modes", "") ||
                          !keeps(settings, "solver", "") ||
                          !keeps(settings, "jacobian", "");
  List list(line, settings);
  if (of_strands) return {};
  for (const Problem& problem : problems()) {
    if (!wanted(line.models, problem.model)) continue;
    if (keeps(settings, "scene", problem.name)) list.add(problem);
  }
  return list.cases();
}

}  // namespace tress::experiments::work_precision
