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

/// Searches for the largest step that `judge` finds stable (empty: the work is used up)
/// and fills the columns about it. The row fails, and nothing is returned, if no stable
/// step exists or none was found within the work limit.
std::optional<FoundLimit> find_limit(
    const StepSearch& search,
    const std::function<std::optional<StabilityRun>(double dt)>& judge, Row& row);

/// Sets the columns about the run at the limit and the cost (s of wall time) of one of
/// its steps.
void set_cost(const FoundLimit& limit, double cost, Row& row);

}  // namespace tress::experiments::stability_limit
