#pragma once

#include <vector>

#include "experiments/harness/row.h"

namespace tress {

/// Fills what only the whole table knows: `order_fit` of every fixed-step series (same
/// scene, integrator and formulation; least-squares slope over its finest trusted points)
/// and `pareto` of every row (no run of its scene is both faster and more accurate).
void add_series_columns(std::vector<Row>& rows);

}  // namespace tress
