#include "experiments/stability_limit/limit_row.h"

#include <fmt/format.h>

#include <cmath>

namespace tress {

void set_limit(const StepLimit& limit, const StepSearch& search, Row& row) {
  row.set("dt_max_s", limit.stable).set("dt_first_unstable_s", limit.unstable);
  row.set("stable_above_s", limit.stable_above).set("dt_finest_s", limit.finest);
  row.set("search_done", limit.complete).set("runs", limit.runs);
  if (!std::isnan(limit.unstable)) row.set("limited_by", name(limit.limited_by));
  if (limit.stable >= search.coarsest) row.set("limited_by", "cap");
}

void fail_without_limit(const StepLimit& limit, const StabilityRun* last, Row& row) {
  if (!limit.complete && !limit.resolved) {
    row.failed("gave_up", "the work of a row was used up before the limit was found");
  } else if (std::isnan(limit.stable) && last != nullptr) {
    row.failed("unstable",
               fmt::format("no stable step down to {:.3g} s: {} at t = {:.3g} s {}",
                           limit.finest, name(last->broken), last->t, last->failure));
  }
}

}  // namespace tress
