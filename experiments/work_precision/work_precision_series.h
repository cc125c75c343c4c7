#pragma once

#include <vector>

#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// Fills the columns that depend on the whole table: `order_fit` of every fixed-step
/// series, the least-squares slope over its finest trusted points (same scene,
/// integrator, formulation and solver, over steps; total errors: same model at its finest
/// step, over element lengths; none for the swing), and `pareto` of every row (no run of
/// its scene and kind of error, for time errors also of its number of elements, is both
/// faster and more accurate).
void add_series_columns(std::vector<Row>& rows);

}  // namespace tress::experiments::work_precision
