#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// What the table must show: digits that methods reach on published problems, the order
/// of total errors in element length, what a high order costs BDF on a rod, and the
/// claims about the swing.
void check_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::work_precision
