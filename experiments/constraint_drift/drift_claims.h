#pragma once

#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::constraint_drift {

/// The claims about the table of constraint_drift: feedback helps symplectic Euler,
/// projection and RATTLE are at rounding level, index 2 is near its tolerance, parametric
/// forms do not drift, critical damping is fastest without overshoot, limits of the gains
/// are as predicted, lengths of shaken strands are corrected.
void check_drift_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::constraint_drift
