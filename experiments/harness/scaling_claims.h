#pragma once

#include <vector>

#include "experiments/harness/row.h"
#include "experiments/harness/verdicts.h"

namespace tress {

/// Fills `exponent` of every series of straight strands (same model, solver, tangent and
/// modes): p of cost ~ N^p, fitted to what was measured from 20 elements on, three sizes
/// at least.
void add_exponents(std::vector<Row>& rows);

/// What the table of scaling must show of the super-helix with the papers' tangent: the
/// recursion's cost is linear and its element cheap, the composite's is a multiple of it
/// that grows, fewer unknowns take less time.
void check_scaling_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress
