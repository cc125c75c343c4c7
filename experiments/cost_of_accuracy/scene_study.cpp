#include "experiments/cost_of_accuracy/scene_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "experiments/cost_of_accuracy/finalists.h"
#include "experiments/cost_of_accuracy/methods.h"
#include "experiments/cost_of_accuracy/scene_measure.h"
#include "experiments/cost_of_accuracy/search.h"
#include "experiments/cost_of_accuracy/study_table.h"
#include "experiments/scenes/scene_tables.h"
#include "models/input_error.h"

namespace tress {
namespace {

/// How much longer than usual a run may take on a machine that does other things too.
constexpr double noise = 1.5;

/// Of the work of a search; what is left is for the best of what was found.
constexpr double coarse_share = 0.6;
/// As much again may go into what replaces each choice of the winners.
constexpr double last_share = 2;

/// What all rows of a scene are written from.
struct Study {
  const StudyPlan& plan;
  const SceneText text;
  const Row& identity;
  Comparison comparison = {};  // cut where the references part
  bool cut = false;
  SceneReference reference = {};
  std::optional<SceneReference> refined = {};
  ChangedTips changed = {};
  std::vector<Method> methods = {};

  double gap() const { return reference.tips.gap; }
  double floor() const { return believed * gap(); }
};

Study ready(const std::string& file, const StudyPlan& plan, const Row& identity) {
  Study study{.plan = plan, .text = SceneText(file), .identity = identity};
  const std::string name = study.text.given().name;
  study.comparison = comparison(study.text, plan.rate, plan.horizon, plan.strands);
  const auto kept = [&](const ReferenceCut& cut, const std::string& as) {
    return kept_reference(study.text, study.comparison, cut, plan.references, as);
  };
  const SceneReference whole = kept(plan.reference, name);
  std::optional<SceneReference> fine;
  if (plan.refine) fine = kept(plan.reference.refined(), name + ".refined");
  study.reference = agreed(whole, study.comparison, parted);
  study.changed = kept_changed_tips(study.text, study.comparison, study.reference,
                                    plan.reference.halved(), plan.references, name);
  study.cut = study.reference.frames < study.comparison.frames;
  study.comparison.frames = study.reference.frames;
  if (fine) study.refined = first_frames(*fine, study.comparison);
  study.methods = methods(study.text, plan.methods);
  return study;
}

/// Counts the work of a search.
class Work {
 public:
  Work(const Study& study, const Deadline& deadline)
      : most_(study.plan.search_work),
        steps_(static_cast<double>(study.comparison.frames * study.comparison.strands)),
        deadline_(deadline) {}

  double done() const { return done_; }
  void add(int elements, int substeps) { done_ += steps_ * elements * substeps; }
  /// Tells when so much of the work was done, or time is over.
  std::function<bool()> until(double share) const {
    return [this, share] { return done_ >= share * most_ || deadline_.passed(); };
  }

 private:
  double most_, steps_, done_ = 0;
  const Deadline& deadline_;
};

Row begin(const Study& study, std::string_view kind) {
  Row row = study.identity;
  row.set("kind", kind).set("reference_gap", study.gap());
  if (study.refined) row.set("refined_gap", study.refined->tips.gap);
  row.set("horizon_s", study.comparison.horizon()).set("horizon_cut", study.cut);
  return row;
}

void set_wall(const Study& study, double wall_s, Row& row) {
  row.set("wall_s_per_sim_s", wall_s / study.comparison.horizon());
  row.set("ms_per_frame", 1e3 * wall_s / static_cast<double>(study.comparison.frames));
}

Row row_of(const Study& study, std::string_view kind, const Trial& run) {
  Row row = begin(study, kind);
  set_method(study.methods[run.method], row);
  row.set("elements", run.elements);
  row.set("dt_s", 1 / (study.comparison.rate * run.substeps));
  row.set("error_rel", run.error);
  if (run.examined == neighbour_count) row.set("error_neighbours_rel", run.neighbours);
  set_wall(study, run.wall_s, row);
  return row;
}

SceneMeasure measure_of(const Study& study) {
  return {study.text, study.comparison, study.reference.tips.tip, study.changed};
}

/// Why there is no winner.
std::string not_met(bool cut) {
  return cut ? "no run within the target with neighbours that hold, so far: the search "
               "ended with its work"
             : "no run within the target with neighbours that hold";
}

void add_target(const Study& study, Finalists& finalists, double target,
                std::vector<Row>& rows) {
  if (target < study.floor()) {
    Row row = begin(study, "winner");
    row.set("target_error_rel", target);
    rows.push_back(row.failed("below_reference",
                              fmt::format("target {} < {} x gap {:.3g} of the references",
                                          target, believed, study.gap())));
    return;
  }
  const auto met = finalists.of(target - study.gap());
  if (!met) {
    const auto nearest = finalists.nearest();
    Row row = nearest ? row_of(study, "winner", *nearest) : begin(study, "winner");
    row.set("target_error_rel", target);
    rows.push_back(row.failed("not_met", not_met(finalists.cut())));
    return;
  }
  const auto add = [&](std::string_view kind, const Trial& run) -> Row& {
    Row row = row_of(study, kind, run);
    row.set("target_error_rel", target);
    row.set("margin", (run.neighbours + study.gap()) / target);
    row.set("cost_factor", run.wall_s / met->winner.wall_s);
    row.set("time_scatter", finalists.scatter(run));
    rows.push_back(std::move(row));
    return rows.back();
  };
  const auto check_refined = [&](const Trial& run, Row& row) {
    if (!study.refined) return;
    row.set("error_refined_rel",
            measure_of(study).error(study.methods[run.method], run.elements, run.substeps,
                                    study.refined->tips.tip));
  };
  check_refined(met->winner, add("winner", met->winner).set("rank", 1));
  if (met->runner_up) {
    const bool tied = finalists.tied(*met->runner_up, met->winner);
    Row& row = add("runner_up", *met->runner_up).set("rank", tied ? 1 : 2);
    check_refined(*met->runner_up, row.set("tied", tied));
  }
  for (const auto& [choice, run] : met->without) {
    if (run) {
      const bool tied = finalists.tied(*run, met->winner);
      add("without", *run).set("choice", choice).set("tied", tied);
      continue;
    }
    Row row = begin(study, "without");
    row.set("target_error_rel", target).set("choice", choice);
    rows.push_back(row.failed("not_met", "none that was tried meets the target"));
  }
}

void add_budget(const Study& study, Finalists& finalists, std::vector<Row>& rows) {
  const double budget_s = study.plan.budget_s;
  if (budget_s == 0) return;
  const auto frames = static_cast<double>(study.comparison.frames);
  const auto run = finalists.within(budget_s * frames, study.floor());
  Row row = run ? row_of(study, "budget", *run) : begin(study, "budget");
  row.set("budget_ms", 1e3 * budget_s);
  if (!run) {
    row.failed("not_met", "no run in the time there is");
  } else if (run->error < study.floor()) {
    row.failed("below_reference", "more accurate than the reference can tell");
  }
  rows.push_back(std::move(row));
}

/// The scene with the file's own model, integrator, elements and step; steps end at the
/// frames of the comparison.
void add_given(const Study& study, std::vector<Row>& rows) {
  const Scene& given = study.text.given();
  Row row = begin(study, "as_given");
  Method method{given.model, {}, given.integrator, given.options.formulation};
  for (const Parameter& p : model_table_parameters(*given.model)) {
    if (p.name == "id" || p.choices.empty()) continue;
    const std::string_view word = given.model_options.word(p.name);
    if (word != words_of(p.choices).front()) method.options.emplace_back(p.name, word);
  }
  set_method(method, row);
  row.set("elements", given.strands.front().segments.size());
  row.set("dt_s", given.options.step);
  const auto run = measure_of(study).best_of(given, study.plan.repeat);
  if (!run) {
    row.failed("diverged", "the scene as given does not run to the horizon");
  } else {
    row.set("error_rel", run->error);
    set_wall(study, run->wall_s, row);
  }
  rows.push_back(std::move(row));
}

/// Answers everything until nothing changes an answer before it: what replaces a choice
/// of a winner must not turn out cheaper than the winner. Every round but the last tries
/// or times a run that none did before, so there are few.
void settle(const Study& study, Finalists& finalists, const std::vector<double>& targets,
            const Deadline& deadline) {
  std::size_t before = 0;
  while (finalists.known() != before && !deadline.passed()) {
    before = finalists.known();
    for (const double target : targets) static_cast<void>(finalists.of(target));
    static_cast<void>(finalists.front(study.floor(), study.plan.targets.front()));
  }
}

std::vector<Row> all_rows(Study& study, const Deadline& deadline) {
  const StudyPlan& plan = study.plan;
  const SceneMeasure measure = measure_of(study);
  SearchPlan search_plan{.targets = {},
                         .elements = plan.elements,
                         .substeps = plan.substeps,
                         .longest_run = plan.longest_run,
                         .slack = 0};
  for (const double target : plan.targets) {
    if (target >= study.floor()) search_plan.targets.push_back(target - study.gap());
  }
  search_plan.slack = ladder_slack(search_plan, noise);
  std::vector<Row> rows;
  if (search_plan.targets.empty()) {
    Row row = begin(study, "winner");
    rows.push_back(row.failed(
        "below_reference",
        fmt::format("all targets are < {} x gap {:.3g}", believed, study.gap())));
    return rows;
  }
  Work work(study, deadline);
  Search search(
      search_plan, study.methods.size(),
      [&](std::size_t method, int elements, int substeps) {
        work.add(elements, substeps);
        auto run = measure.quick(study.methods[method], elements, substeps,
                                 deadline.remaining_s());
        if (run) run->method = method;
        return run;
      },
      [&](const Trial& run, Neighbour change) {
        work.add(run.elements, run.substeps);
        return measure.changed_error(
            study.methods[run.method], run.elements, run.substeps,
            change == Neighbour::data_up ? Change::up : Change::down,
            deadline.remaining_s());
      },
      work.until(coarse_share));
  search.coarse();
  std::string how =
      fmt::format("{}: {} of {} methods climbed", search.cut() ? "cut" : "whole",
                  search.tried(), study.methods.size());
  search.go_on(work.until(1));
  search.refine();
  if (search.cut()) how += ", cut while refining";
  search.go_on(work.until(last_share));
  Finalists finalists(search, study.text, study.methods, [&](const Trial& run) {
    return measure.time(study.methods[run.method], run.elements, run.substeps,
                        plan.repeat);
  });
  settle(study, finalists, search_plan.targets, deadline);
  for (const double target : plan.targets) add_target(study, finalists, target, rows);
  add_budget(study, finalists, rows);
  for (const Trial& run : finalists.front(study.floor(), plan.targets.front())) {
    rows.push_back(row_of(study, "front", run));
  }
  add_given(study, rows);
  if (search.cut()) how += ", cut while settling";
  if (deadline.passed()) how += ", by the clock";
  for (Row& row : rows) {
    row.set("runs", search.runs().size()).set("passed_over", search.passed_over());
    row.set("work", 1e-6 * work.done()).set("search", how);
  }
  return rows;
}

}  // namespace

std::vector<Row> study_scene(const std::string& file, const StudyPlan& plan,
                             const Row& identity, const Deadline& deadline) {
  std::optional<Study> study;
  try {
    study.emplace(ready(file, plan, identity));
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& failure) {
    Row row = identity;
    return {row.failed("no_reference", failure.what())};
  }
  return all_rows(*study, deadline);
}

}  // namespace tress
