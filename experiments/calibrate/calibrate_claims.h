#pragma once

#include <string_view>
#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::calibrate {

namespace calibrate {

constexpr std::string_view fitting = "implicit_midpoint";  // adds no damping
constexpr std::string_view damping = "backward_euler";

}  // namespace calibrate

/// Claims about rows of simulated records: the true value lies in its interval, and rows
/// without an answer (one length for two values, a method that adds damping) report it.
void check_calibrate_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::calibrate
