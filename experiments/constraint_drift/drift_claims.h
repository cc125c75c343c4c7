#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::constraint_drift {

/// What the table of constraint_drift must show: feedback that helps symplectic Euler,
/// projection and RATTLE at rounding, index 2 near its tolerance, parametric forms
/// without drift, critical damping fastest of all that do not overshoot, limits of the
/// gains as predicted, lengths of shaken strands corrected.
void check_drift_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::constraint_drift
