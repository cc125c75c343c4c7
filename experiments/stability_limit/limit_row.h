#pragma once

#include "experiments/numerics/stability.h"
#include "simulation/files/row.h"

namespace tress {

/// The columns about the limit that was found.
void set_limit(const StepLimit& limit, const StepSearch& search, Row& row);

/// The reason of a row whose method has no stable step, or whose search found none in its
/// work; `last` broke at limit.unstable.
void fail_without_limit(const StepLimit& limit, const StabilityRun* last, Row& row);

}  // namespace tress
