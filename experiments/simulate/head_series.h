#pragma once

#include <span>
#include <vector>

#include "simulation/run/head_run.h"
#include "simulation/run/readout.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// The time series of a head: its columns, and a row of them from the energies of all
/// strands, which are summed in the order of the strands, without those that are lost.
const std::vector<Reading>& head_series();
std::vector<double> head_series_row(double t, const models::Head& head,
                                    std::span<const models::HeadEnergy> each);

}  // namespace tress::experiments::scene_runs
