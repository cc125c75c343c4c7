#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::scaling {

/// Fills `exponent` of every series of straight strands (same model, solver, tangent and
/// modes) and of scene files: p of cost ~ N^p, fitted to what was measured from 20
/// elements on, or to all numbers of strands, three sizes at least.
void add_exponents(std::vector<Row>& rows);

/// What the table of scaling tells of the super-helix with the papers' tangent, as
/// figures of the machine: how the recursion's cost grows and what its element costs, by
/// how much the composite is dearer, and what fewer unknowns save.
void tell_scaling_figures(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::scaling
