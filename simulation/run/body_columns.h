#pragma once

#include <span>
#include <string>
#include <vector>

#include "models/effects/driven_body.h"
#include "simulation/run/readout.h"
#include "simulation/scene/driven_bodies.h"

/// Columns of bodies that strands drive in the time series.
namespace tress::simulation {

/// Returns the columns of a body.
std::vector<Reading> columns_of(const DrivenName& body);
/// Appends the motion of a body to a row, in the order of its columns.
void append_motion(const models::DrivenBody& body, const DrivenBodies::Motion& now,
                   std::vector<double>& row);
/// Returns the place of a body of this name in a row with these columns, without
/// velocities.
DrivenBodies::Motion place_in(const models::DrivenBody& body, const std::string& name,
                              const std::vector<Reading>& columns,
                              std::span<const double> row);

}  // namespace tress::simulation
