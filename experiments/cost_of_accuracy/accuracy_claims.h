#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::cost_of_accuracy {

/// What the table must show, of every scene: its winners keep their error with the
/// reference refined once more; neither are they luck, by their neighbours; and no run
/// that stands beside a winner, for the same target or in the front, beats it.
void check_accuracy_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::cost_of_accuracy
