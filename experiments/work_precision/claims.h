#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// The claims about the table: digits reached on published problems, the order of total
/// errors in element length, the cost of a high BDF order on a rod, and the claims about
/// the swing.
void check_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::work_precision
