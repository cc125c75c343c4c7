#pragma once

#include <vector>

#include "simulation/files/row.h"

namespace tress::experiments::divided_heads {

/// Adds the predictions of the model to all rows, if enough rows were measured to fit its
/// numbers. Predictions are cost and efficiency, the difference from measured rows, and
/// the difference of a model fitted to the other numbers of hairs only. More ranks than
/// cores take turns.
void add_predictions(std::vector<Row>& rows);

}  // namespace tress::experiments::divided_heads
