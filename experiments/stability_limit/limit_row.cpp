#include <fmt/format.h>

#include <cmath>

#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

void set_limit(const StepLimit& limit, const StepSearch& search, Row& row) {
  row.set("dt_max_s", limit.stable).set("dt_first_unstable_s", limit.unstable);
  row.set("stable_above_s", limit.stable_above).set("dt_finest_s", limit.finest);
  row.set("search_done", limit.complete).set("runs", limit.runs);
  row.set("stable_runs", limit.stable_runs);
  if (!std::isnan(limit.unstable)) row.set("limited_by", name(limit.limited_by));
  if (limit.stable >= search.coarsest) row.set("limited_by", "cap");
}

}  // namespace

SearchedSteps search_steps(const StepSearch& search, const JudgeStep& judge) {
  SearchedSteps all;
  all.complete = find_step_limit(search, [&](double dt) -> std::optional<Broken> {
                   const auto run = judge(dt);
                   if (!run) return {};
                   return (all.runs[dt] = *run).broken;
                 }).complete;
  return all;
}

StepLimit step_limit(const SearchedSteps& searched, const StepSearch& search) {
  TestedSteps tested;
  for (const auto& [dt, run] : searched.runs) tested[dt] = run.broken;
  StepLimit limit = experiments::step_limit(tested, search.resolution);
  limit.complete = searched.complete;
  return limit;
}

std::optional<FoundLimit> found_limit(const SearchedSteps& searched,
                                      const StepSearch& search, Row& row) {
  const StepLimit limit = step_limit(searched, search);
  set_limit(limit, search, row);
  if (!limit.complete && !limit.resolved) {
    row.failed("gave_up", "the work of a row was used up before the limit was found");
  } else if (std::isnan(limit.stable)) {
    const StabilityRun& last = searched.runs.at(limit.unstable);
    row.failed("unstable",
               fmt::format(
                   "every step tried down to {:.3g} s is unstable: {} at t = {:.3g} s {}",
                   limit.finest, name(last.broken), last.t, last.failure));
  }
  if (std::isnan(limit.stable)) return {};
  return FoundLimit{limit.stable, searched.runs.at(limit.stable)};
}

std::optional<FoundLimit> find_limit(const StepSearch& search, const JudgeStep& judge,
                                     Row& row) {
  return found_limit(search_steps(search, judge), search, row);
}

void set_cost(const FoundLimit& limit, double cost, Row& row) {
  const Stats& stats = limit.run.stats;
  row.set("steps", stats.steps).set("newton_iterations", stats.newton_iterations);
  row.set("cost_per_step_s", cost).set("realtime_factor", limit.step / cost);
}

}  // namespace tress::experiments::stability_limit
