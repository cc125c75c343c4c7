#pragma once

#include <vector>

#include "integrators/catalogue.h"

namespace tress::experiments {

/// The formulations by which an integrator drives a system, its preferred one first.
/// Excludes Baumgarte feedback, whose gains are the subject of constraint_drift.
std::vector<Formulation> usable_formulations(const IntegratorEntry& entry,
                                             System& system);

}  // namespace tress::experiments
