#pragma once

#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::stability_limit {

/// The study `nodal`: is a nodal scheme of Kirchhoff's equations with the stiffness of
/// curvature removed unstable for a hair of 200 nodes at steps of 1e-5 s [Bertails 2006],
/// and which steps does it need? Empty if the command line selects other rows.
std::vector<Case> nodal_cases(const CommandLine& line, const Settings& settings);

/// Checks that claim, method by method; that in a plane the limit falls as 1/N^2; and
/// that the limits of explicit methods are those of the grid's highest frequency.
void check_nodal_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::stability_limit
