#pragma once

#include <functional>
#include <optional>

#include "experiments/numerics/stability.h"
#include "simulation/files/row.h"

namespace tress::experiments::stability_limit {

/// The largest stable step (s), and the run at it.
struct FoundLimit {
  double step;
  StabilityRun run;
};

/// Looks for the largest step that `judge` calls stable (empty: the work is used up) and
/// fills the columns about it; the row fails where no stable step was found, which is
/// when nothing is returned, or not in the work that there was.
std::optional<FoundLimit> find_limit(
    const StepSearch& search,
    const std::function<std::optional<StabilityRun>(double dt)>& judge, Row& row);

/// The columns about the run at the limit and what a step (s of wall time) of it costs.
void set_cost(const FoundLimit& limit, double cost, Row& row);

}  // namespace tress::experiments::stability_limit
