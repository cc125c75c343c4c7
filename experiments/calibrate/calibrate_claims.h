#pragma once

#include <string_view>
#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::calibrate {

namespace calibrate {

constexpr std::string_view fitting = "implicit_midpoint";  // does not damp by itself
constexpr std::string_view damping = "backward_euler";

}  // namespace calibrate

/// What the rows of simulated records must show: the truth inside its interval, and
/// where there can be no answer (one length for two values, a method that damps by
/// itself) that the row says so.
void check_calibrate_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::calibrate
