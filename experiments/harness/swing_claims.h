#pragma once

#include <vector>

#include "experiments/harness/row.h"
#include "experiments/harness/verdicts.h"

namespace tress {

/// What the table of swing must show: at the peers' number of elements a time error of
/// 1 % within 20 ms and of 0.1 % within 50 ms; a total error of 1 % within 4 ms; that
/// twist does not matter; that the references agree. Claims without a row that could
/// decide them are left out.
void check_swing_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress
