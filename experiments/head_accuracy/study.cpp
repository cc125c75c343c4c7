#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "experiments/head_accuracy/head_accuracy.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::head_accuracy {
namespace {

constexpr Column columns[] = {
    {"scene", "name of the scene, or of one of the study's grooms"},
    {"kind",
     "cheapest (for a target), every (the same with every hair simulated), bits (the "
     "same "
     "in 64 bits), budget (the most accurate within a time), as_given (by the file), "
     "front "
     "(no other run has less error and less time)"},
    {"target_error_rel", "wanted error over the length of each hair"},
    {"over", "what of the hairs' errors is wanted: mean, p95 (of 95 of 100), largest"},
    {"budget_ms", "of kind budget: wall time per frame that there is"},
    {"strands", "hairs of the scene"},
    {"looked_at", "hairs that are compared: all, or those of a groom of fewer"},
    {"guides", "hairs that are simulated; the others follow them"},
    {"elements", "of each"},
    {"dt_s", "step"},
    {"bits", "of a number of the simulation"},
    {"error_mean_rel",
     "distance of a hair from itself simulated finely, rms over its length and time, "
     "over "
     "its length: mean over all hairs"},
    {"error_p95_rel", "the same: 95 of 100 hairs are below"},
    {"error_max_rel", "the same: largest"},
    {"interpolation_mean_rel",
     "the same if guides moved as in the reference: what following them costs"},
    {"interpolation_p95_rel", "the same: 95 of 100 hairs are below"},
    {"interpolation_max_rel", "the same: largest"},
    {"simulated_mean_rel", "of the guides alone: what elements and steps cost"},
    {"simulated_p95_rel", "the same: 95 of 100 guides are below"},
    {"simulated_max_rel", "the same: largest"},
    {"error_neighbours_rel",
     "largest error of neighbours: a tenth more and fewer guides, an element more, 1.5 "
     "times the steps"},
    {"margin", "the same and the gap over the wanted error; at most 1.5, or it is luck"},
    {"reference_gap",
     "what the reference gains by its last extrapolation, in elements: a bound of its "
     "error"},
    {"best_guides", "number of guides, up to half of the hairs, that others follow best"},
    {"best_interpolation_rel", "error of hairs that follow them"},
    {"work",
     "of a frame: steps of elements, half of 32 bits, more where they wind far, and 0.35 "
     "of a point that follows"},
    {"step_ms_per_frame", "wall time of the steps of a frame, median", true},
    {"follow_ms_per_frame", "the same of reading points and of hairs that follow", true},
    {"ms_per_frame", "both", true},
    {"bytes", "memory of guides and of hairs that follow"},
    {"horizon_s", "time that is compared"},
    {"runs", "of the whole head that the search took", true},
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
    row.set("elements", choice.elements).set("bits", choice.bits);
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
    if (!judged) row.failed("lost", "hairs have no solution");
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
      add_run("bits", longer, target);
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
