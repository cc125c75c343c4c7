#pragma once

#include <vector>

#include "experiments/harness/row.h"
#include "experiments/harness/verdicts.h"

namespace tress {

/// What the table of stability_limit must show; `resolution` is that of its bisection.
void check_stability_claims(const std::vector<Row>& rows, double resolution,
                            Verdicts& verdicts);

}  // namespace tress
