#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::hard_cases {

/// The claims about the table of hard_cases: every cell has an outcome, and super_helix
/// by backward_euler with the exact tangent passes every case at 1/30 s that it does not
/// refuse, except for known limits.
void check_hard_cases(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::hard_cases
