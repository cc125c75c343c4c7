#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::scaling {

/// Fills `exponent` of every series of straight strands (same model, solver, tangent and
/// modes) and of scene files: p of cost ~ N^p, fitted to the measurements from 20
/// elements on, or to all numbers of strands, with at least three sizes.
void add_exponents(std::vector<Row>& rows);

/// Figures of this machine for the super-helix with the stiff tangent: growth of the
/// recursion's cost and cost per element, cost ratio of the composite, and savings from
/// fewer unknowns.
void tell_scaling_figures(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::scaling
