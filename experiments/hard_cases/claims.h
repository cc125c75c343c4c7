#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::hard_cases {

/// What the table of hard_cases must show: no cell without an outcome, and super_helix by
/// backward_euler with the whole tangent passes every case at 1/30 s that it does not
/// refuse, but for known limits.
void check_hard_cases(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::hard_cases
