#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// The claims about the rows of the swing: runs with a time error of 1 % and of 0.1 % at
/// the peers' number of elements and with a total error of 1 %, whose times are figures;
/// twist does not matter; the references agree.
void check_swing_claims(const std::vector<Row>& all, Verdicts& verdicts);

}  // namespace tress::experiments::work_precision
