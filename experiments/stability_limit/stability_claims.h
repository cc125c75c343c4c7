#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::stability_limit {

/// The claims about the table of stability_limit. Two limits are equal when the brackets
/// of their bisections, from dt_max_s to dt_first_unstable_s, have a step in common; the
/// deciding number is the ratio of the two dt_max_s of the worst pair.
void check_stability_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::stability_limit
