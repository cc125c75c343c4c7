#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::cost_of_accuracy {

/// The claims about every scene of the table: its winners keep their error against a once
/// more refined reference; their neighbours confirm that they are not accidental; and no
/// run listed beside a winner, for the same target or in the front, beats it.
void check_accuracy_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::cost_of_accuracy
