#include <fmt/format.h>

#include <cmath>
#include <map>

#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

void set_limit(const StepLimit& limit, const StepSearch& search, Row& row) {
  row.set("dt_max_s", limit.stable).set("dt_first_unstable_s", limit.unstable);
  row.set("stable_above_s", limit.stable_above).set("dt_finest_s", limit.finest);
  row.set("search_done", limit.complete).set("runs", limit.runs);
  if (!std::isnan(limit.unstable)) row.set("limited_by", name(limit.limited_by));
  if (limit.stable >= search.coarsest) row.set("limited_by", "cap");
}

}  // namespace

std::optional<FoundLimit> find_limit(
    const StepSearch& search,
    const std::function<std::optional<StabilityRun>(double dt)>& judge, Row& row) {
  std::map<double, StabilityRun> runs;
  const StepLimit limit =
      find_step_limit(search, [&](double dt) -> std::optional<Broken> {
        const auto run = judge(dt);
        if (!run) return {};
        return (runs[dt] = *run).broken;
      });
  set_limit(limit, search, row);
  if (!limit.complete && !limit.resolved) {
    row.failed("gave_up", "the work of a row was used up before the limit was found");
  } else if (std::isnan(limit.stable)) {
    const StabilityRun& last = runs.at(limit.unstable);
    row.failed("unstable",
               fmt::format("no stable step down to {:.3g} s: {} at t = {:.3g} s {}",
                           limit.finest, name(last.broken), last.t, last.failure));
  }
  if (std::isnan(limit.stable)) return {};
  return FoundLimit{limit.stable, runs.at(limit.stable)};
}

void set_cost(const FoundLimit& limit, double cost, Row& row) {
  const Stats& stats = limit.run.stats;
  row.set("steps", stats.steps).set("newton_iterations", stats.newton_iterations);
  row.set("cost_per_step_s", cost).set("realtime_factor", limit.step / cost);
}

}  // namespace tress::experiments::stability_limit
