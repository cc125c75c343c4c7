#pragma once

#include "contract/integrator.h"
#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// Fills the columns common to all runs: counters,
void set_counts(const Stats& stats, Row& row);
/// distance from the reference, whose two sides are `gap` apart,
void set_error(double relative, double gap, Row& row);
/// and times (s).
void set_time(double wall, double simulated, Row& row);

}  // namespace tress::experiments::work_precision
