#include "experiments/cost_of_accuracy/study_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/scene_tables.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Frames of the horizon at the requested rate, with the part of the last one.
double frames(const Study& study) { return study.comparison.horizon() * study.plan.rate; }

void set_wall(const Study& study, double wall_s, Row& row) {
  row.set("wall_s_per_sim_s", wall_s / study.comparison.horizon());
  row.set("ms_per_frame", 1e3 * wall_s / frames(study));
}

/// A run whose error exceeds the loosest target by this factor is abandoned.
constexpr double useless = 10;

/// Reason for the missing winner.
std::string not_met(bool cut) {
  return cut ? "no run within the target with neighbours that hold, so far: the search "
               "ended with its work"
             : "no run within the target with neighbours that hold";
}

/// Reason where no run of the search was compared.
std::string no_run(double target) {
  return fmt::format("no run came to its end within {:.2g} % of the length",
                     1e2 * useless * target);
}

/// The first line of a message.
std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

Row begin(const Study& study, std::string_view kind) {
  Row row = study.identity;
  row.set("kind", kind).set("reference_gap", study.gap());
  if (held(study.given)) row.set("error_of", "strand");
  if (study.refined) row.set("refined_gap", study.refined->tips.gap);
  row.set("horizon_s", study.comparison.horizon()).set("horizon_cut", study.cut());
  const double horizon = study.plan.horizon, duration = study.given.duration;
  row.set("asked_s", horizon > 0 ? std::min(horizon, duration) : duration);
  row.set("duration_s", duration);
  if (study.cut()) row.set("parted_rel", study.beyond);
  if (!study.how.empty()) row.set("references", study.how);
  return row;
}

Row row_of(const Study& study, std::string_view kind, const Trial& run) {
  Row row = begin(study, kind);
  set_method(study.methods[run.method], row);
  row.set("elements", run.elements);
  const Method& method = study.methods[run.method];
  const Accuracy chosen = accuracy(method, run.substeps, study.comparison.rate);
  if (method.by_tolerance) {
    row.set("position_tol_rel", chosen.tolerance);
    if (run.steps > 0) row.set("mean_step_s", study.comparison.horizon() / run.steps);
  } else {
    row.set("dt_s", chosen.step);
  }
  row.set("error_rel", run.error);
  if (run.examined == neighbour_count) {
    row.set("error_neighbours_rel", run.neighbours);
    row.set("worst_neighbour", name(run.worst, {.by_tolerance = method.by_tolerance,
                                                .element_unit = study.element_unit,
                                                .held = held(study.given)}));
  }
  if (run.indicator > 0) row.set("error_indicator", run.indicator);
  set_wall(study, run.wall_s, row);
  return row;
}

std::string below_reference(const Study& study, double target) {
  const std::string why =
      fmt::format("target {:.3g} % < {} x {:.3g} %, the gap of the references",
                  1e2 * target, study.trusted(), 1e2 * study.gap());
  if (!study.plan.advise) return why;
  return fmt::format(
      "{}: give --set accuracy={:.2g} or more, or more time (--set answer_s)", why,
      1.05 * study.floor());
}

SceneMeasure measure_of(const Study& study) {
  return {study.given,   study.comparison,       study.reference.tips.tip,
          study.changed, study.plan.longest_run, useless * study.plan.targets.front()};
}

void add_target(const Study& study, Finalists& finalists, double target,
                std::vector<Row>& rows) {
  if (target < study.floor()) {
    Row row = begin(study, "winner");
    row.set("target_error_rel", target);
    rows.push_back(row.failed("below_reference", below_reference(study, target)));
    return;
  }
  const auto met = finalists.of(target - study.gap(), !study.plan.advise);
  if (!met) {
    const auto nearest = finalists.nearest();
    Row row = nearest ? row_of(study, "winner", *nearest) : begin(study, "winner");
    row.set("target_error_rel", target);
    rows.push_back(row.failed("not_met", nearest ? not_met(finalists.cut())
                                                 : no_run(study.plan.targets.front())));
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

void add_control(const Study& study, Finalists& finalists, double target,
                 std::vector<Row>& rows) {
  if (target < study.floor()) return;
  for (const std::string& id : study.plan.control) {
    const ModelEntry& model = find_model(id);
    if (std::ranges::find(study.methods, &model, &Method::model) == study.methods.end()) {
      continue;
    }
    const ControlCompared both = finalists.control(model, target - study.gap());
    const auto add = [&](std::string_view kind, const std::optional<Trial>& run) {
      Row row = run ? row_of(study, kind, *run) : begin(study, kind);
      row.set("model", id).set("target_error_rel", target);
      if (run) {
        row.set("margin", (run->neighbours + study.gap()) / target);
        row.set("time_scatter", finalists.scatter(*run));
        if (both.by_step) row.set("cost_factor", run->wall_s / both.by_step->wall_s);
      } else {
        row.failed("not_met", not_met(finalists.cut()));
      }
      rows.push_back(std::move(row));
    };
    add("by_step", both.by_step);
    add("by_tolerance", both.by_tolerance);
  }
}

void add_left_out(const Study& study, std::vector<Row>& rows) {
  for (const LeftOut& one : study.left_out) {
    Row row = begin(study, "left_out");
    row.set("choice", one.id).failed("refused", first_line(one.why));
    rows.push_back(std::move(row));
  }
}

void add_budget(const Study& study, Finalists& finalists, std::vector<Row>& rows) {
  const double budget_s = study.plan.budget_s;
  if (budget_s == 0) return;
  const auto run = finalists.within(budget_s * frames(study), study.floor());
  Row row = run ? row_of(study, "budget", *run) : begin(study, "budget");
  row.set("budget_ms", 1e3 * budget_s);
  if (!run) {
    row.failed("not_met", "no run in the time there is");
  } else if (run->error < study.floor()) {
    row.failed("below_reference", "more accurate than the reference can tell");
  }
  rows.push_back(std::move(row));
}

bool confirm(const Study& study, Row& row) {
  const double rate = study.comparison.rate;
  const std::string text = advised_text(study.given, row, rate);
  std::string why;
  const auto run =
      measure_of(study).best_of(parse_scene(text, "advised scene"), 0, never, why);
  if (!run) {
    row.failed("file_differs",
               "the advised file does not run to the end: " + first_line(why));
    return false;
  }
  const double promised = row.number("error_rel");
  row.set("error_rel", run->error);
  if (run->error <= std::max(promised, row.number("target_error_rel") - study.gap())) {
    return true;
  }
  row.failed(
      "file_differs",
      fmt::format("the advised file has an error of {:.3g}, the search found {:.3g}",
                  run->error, promised));
  return false;
}

void add_given(const Study& study, double most_s, std::vector<Row>& rows) {
  const Scene& given = study.given;
  Row row = begin(study, "as_given");
  Method method{{given.model, {}, given.integrator, given.options.formulation}};
  method.refresh = given.options.refresh;
  method.by_tolerance = given.options.tolerance > 0;
  for (const Parameter& p : model_table_parameters(*given.model)) {
    if (p.name == "id" || p.choices.empty()) continue;
    const std::string_view word = given.model_options.word(p.name);
    if (word != words_of(p.choices).front()) method.options.emplace_back(p.name, word);
  }
  set_method(method, row);
  row.set("elements", given.strands.front().segments.size());
  if (method.by_tolerance) {
    row.set("position_tol_rel", given.options.tolerance);
  } else {
    row.set("dt_s", given.options.step);
  }
  std::string why;
  const auto run = measure_of(study).best_of(given, study.plan.repeat, most_s, why);
  if (!run) {
    const bool late = why.find("takes too long") != why.npos;
    row.failed(late ? "timeout" : "diverged", "the scene as given: " + first_line(why));
  } else {
    row.set("error_rel", run->error);
    if (run->indicator > 0) row.set("error_indicator", run->indicator);
    set_wall(study, run->wall_s, row);
  }
  rows.push_back(std::move(row));
}

}  // namespace tress::experiments::cost_of_accuracy
