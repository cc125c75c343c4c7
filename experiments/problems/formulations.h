#pragma once

#include <optional>
#include <vector>

#include "integrators/catalogue.h"

namespace tress::experiments {

/// The formulations by which an integrator drives a system, its preferred one first.
/// Excludes Baumgarte feedback, whose gains are the subject of constraint_drift.
std::vector<Formulation> usable_formulations(const IntegratorEntry& entry,
                                             System& system);

/// The preferred one for a run with this Options::tolerance; 0: with a fixed step. Error
/// control takes no index 3. Empty: the integrator cannot drive the system.
std::optional<Formulation> preferred_formulation(const IntegratorEntry& entry,
                                                 System& system, double tolerance = 0);

}  // namespace tress::experiments
