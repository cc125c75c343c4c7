#pragma once

#include "contract/integrator.h"
#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// The columns that every run fills: what it counted,
void set_counts(const Stats& stats, Row& row);
/// how far it is from its reference, whose two sides are `gap` apart,
void set_error(double relative, double gap, Row& row);
/// and what it took (s).
void set_time(double wall, double simulated, Row& row);

}  // namespace tress::experiments::work_precision
