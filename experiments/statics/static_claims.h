#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::statics {

/// Judges the shipped scenes by published loads: the deep arch of DaDeppo & Schmidt, and
/// Euler's column.
void judge(const std::vector<simulation::Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::statics
