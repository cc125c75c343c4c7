#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "contract/input_error.h"
#include "experiments/head_accuracy/head_accuracy.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::head_accuracy {
namespace {

constexpr Column columns[] = {
    {"scene", "name of the scene, or of one of the study's grooms"},
    {"kind",
     "cheapest (for a target), every (with every hair simulated), bits (in "
     "double precision), budget (most accurate within a time), as_given (by the "
     "file), front (Pareto)"},
    {"target_error_rel", "target error over the length of each hair"},
    {"over",
     "statistic of the hairs' errors that has the target: mean, p95 (95th "
     "percentile), largest"},
    {"budget_ms", "wall time allowed per frame, in kind budget"},
    {"strands", "hairs of the scene"},
    {"looked_at", "hairs that are compared: all, or those of a groom of fewer"},
    {"guides", "hairs that are simulated; the others follow them"},
    {"elements", "number of elements of each hair"},
    {"dt_s", "step"},
    {"precision", "floating-point precision of the simulation in bits"},
    {"error_mean_rel",
     "mean error of the hairs: distance from the fine simulation of the same "
     "hair, rms over length and time, over its length"},
    {"error_p95_rel", "95th percentile of the error of the hairs"},
    {"error_max_rel", "largest error of the hairs"},
    {"interpolation_mean_rel",
     "mean error if guides moved as in the reference: the error of following "
     "guides"},
    {"interpolation_p95_rel",
     "95th percentile of the error if guides moved as in the reference"},
    {"interpolation_max_rel", "largest error if guides moved as in the reference"},
    {"simulated_mean_rel", "mean error of the guides: the error of elements and steps"},
    {"simulated_p95_rel", "95th percentile of the error of the guides"},
    {"simulated_max_rel", "largest error of the guides"},
    {"error_neighbours_rel",
     "largest error of neighbours: a tenth more and fewer guides, an element more, 1.5 "
     "times the steps"},
    {"margin",
     "error_neighbours_rel and reference_gap together, over the target error; at "
     "most 1.5, or the result is luck"},
    {"reference_gap",
     "change of the reference in its last extrapolation, in elements: a bound of "
     "its error"},
    {"best_guides", "number of guides, up to half of the hairs, that others follow best"},
    {"best_interpolation_rel", "error of the hairs that follow best_guides guides"},
    {"work",
     "work per frame: element steps (half in single precision, more where "
     "elements wind far) and 0.35 per point that follows"},
    {"step_ms_per_frame", "wall time of the steps of a frame, median", true},
    {"follow_ms_per_frame",
     "wall time per frame for reading points and for hairs that follow, median", true},
    {"ms_per_frame", "wall time per frame: step_ms_per_frame and follow_ms_per_frame",
     true},
    {"bytes", "memory of guides and of hairs that follow"},
    {"horizon_s", "time that is compared"},
    {"runs", "runs of the whole groom that the search took", true},
};

void set(const Spread& spread, const std::string& what, Row& row) {
  row.set(what + "_mean_rel", spread.mean).set(what + "_p95_rel", spread.p95);
  row.set(what + "_max_rel", spread.largest);
}

std::string_view name(Over over) {
  constexpr std::string_view names[] = {"mean", "p95", "largest"};
  return names[static_cast<std::size_t>(over)];
}

class Study {
 public:
  Study(const Scene& given, const StudyPlan& plan, const Row& identity,
        const Deadline& deadline)
      : given_(given),
        plan_(plan),
        identity_(identity),
        measure_(given, plan.comparison),
        search_(measure_, plan.search, plan.over,
                [&deadline] { return deadline.passed(); }) {}

  std::vector<Row> rows() {
    for (const double target : plan_.targets) add(target);
    if (plan_.budget_s > 0) add_budget();
    add_given();
    add_front();
    for (Row& row : rows_) row.set("runs", search_.runs().size());
    return std::move(rows_);
  }

 private:
  Row begin(const std::string& kind) const {
    Row row = identity_;
    row.set("kind", kind).set("over", name(plan_.over));
    row.set("strands", measure_.all_hairs()).set("looked_at", measure_.hairs());
    row.set("reference_gap", gap()).set("horizon_s", measure_.horizon());
    return row;
  }
  double gap() const { return value(measure_.gap(), plan_.over); }

  Row row_of(const std::string& kind, const HeadTrial& trial) const {
    Row row = begin(kind);
    const Choice& choice = trial.choice;
    const bool every = choice.guides == measure_.hairs();
    row.set("guides", every ? measure_.all_hairs() : choice.guides);
    row.set("elements", choice.elements).set("precision", choice.bits);
    row.set("dt_s", 1 / (measure_.comparison().rate * choice.substeps));
    set(trial.all, "error", row);
    set(trial.interpolation, "interpolation", row);
    set(trial.simulated, "simulated", row);
    row.set("work", frame_work(choice, measure_));
    row.set("step_ms_per_frame", 1e3 * trial.step_s);
    row.set("follow_ms_per_frame", 1e3 * trial.follow_s);
    row.set("ms_per_frame", 1e3 * (trial.step_s + trial.follow_s));
    row.set("bytes", trial.bytes);
    return row;
  }

  /// A run that is not among the answers.
  void add_run(const std::string& kind, const Choice& choice, double target = 0) {
    const auto judged = search_.judged(choice);
    Row row = judged ? row_of(kind, judged->trial) : begin(kind);
    if (target > 0) row.set("target_error_rel", target);
    if (!judged) row.failed("failed", "hairs have no solution");
    rows_.push_back(std::move(row));
  }

  void add(double target) {
    if (gap() > target / 2) {
      Row row = begin("cheapest");
      row.set("target_error_rel", target);
      row.failed("below_reference",
                 fmt::format("the reference is known to {:.2g}", gap()));
      rows_.push_back(row);
      return;
    }
    const auto found = search_.cheapest(target);
    const auto judged = found ? found : search_.most_accurate();
    Row row = judged ? row_of("cheapest", judged->trial) : begin("cheapest");
    row.set("target_error_rel", target);
    if (judged) {
      row.set("error_neighbours_rel", judged->neighbours);
      row.set("margin", (judged->neighbours + gap()) / target);
    }
    const auto [guides, spread] = search_.best_interpolation();
    if (guides > 0) {
      row.set("best_guides", guides);
      row.set("best_interpolation_rel", value(spread, plan_.over));
    }
    if (!found) {
      row.failed("not_met", search_.interrupted() ? "out of time"
                                                  : "no run that was tried meets it");
    }
    rows_.push_back(row);
    if (!found) return;
    const Choice taken = found->trial.choice;
    if (taken.bits != 64) {
      Choice longer = taken;
      longer.bits = 64;
      add_run("precision", longer, target);
    }
    if (taken.guides == measure_.hairs()) return;
    Choice every = taken;
    every.guides = measure_.hairs();
    add_run("every", every, target);
  }

  void add_budget() {
    const auto best = search_.best_within(plan_.budget_s);
    Row row = best ? row_of("budget", best->trial) : begin("budget");
    row.set("budget_ms", 1e3 * plan_.budget_s);
    if (best) row.set("error_neighbours_rel", best->neighbours);
    if (!best) row.failed("not_met", "no run that was tried is as fast");
    rows_.push_back(row);
  }

  void add_given() {
    const double rate = measure_.comparison().rate;
    std::size_t guides = 0;
    for (const StrandSource& source : given_.tables->sources) {
      guides += static_cast<std::size_t>(source.table.values().whole("guides"));
    }
    const bool every = guides == 0 || guides >= measure_.hairs();
    add_run("as_given",
            {every ? measure_.hairs() : guides,
             given_.tables->sources.front().table.values().whole("elements"),
             std::max(1, static_cast<int>(std::lround(1 / (rate * given_.options.step)))),
             64});
  }

  /// From the dearest on, without those that gain less than a tenth.
  void add_front() {
    struct Run {
      const HeadTrial* trial;
      double time, error;
    };
    std::vector<Run> all;
    for (const auto& [choice, trial] : search_.runs()) {
      if (!trial) continue;
      all.push_back({&*trial, trial->step_s + trial->follow_s, search_.error(*trial)});
    }
    std::ranges::stable_sort(all, {}, &Run::time);
    double least = std::numeric_limits<double>::infinity();
    for (const Run& run : all) {
      if (run.error > 0.9 * least) continue;
      least = run.error;
      rows_.push_back(row_of("front", *run.trial));
    }
  }

  const Scene& given_;
  const StudyPlan& plan_;
  const Row& identity_;
  HeadMeasure measure_;
  HeadSearch search_;
  std::vector<Row> rows_;
};

}  // namespace

std::span<const Column> head_columns() { return columns; }

std::vector<Row> study_head(const Scene& given, const StudyPlan& plan,
                            const Row& identity, const Deadline& deadline) {
  try {
    return Study(given, plan, identity, deadline).rows();
  } catch (const std::runtime_error& failure) {
    if (dynamic_cast<const InputError*>(&failure) != nullptr) throw;
    Row row = identity;
    return {row.failed("no_reference", failure.what())};
  }
}

}  // namespace tress::experiments::head_accuracy
