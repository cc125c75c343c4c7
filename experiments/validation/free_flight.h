#pragma once

#include <string_view>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::validation {

/// The rows `free_flight`: a hair thrown in space without gravity, spinning. No force and
/// no damping changes its momentum, angular momentum or energy: any change comes from the
/// integrator. For every strand model whose root can be free and every integrator; the
/// rows name the integrator, where the published tests have one of their own.
inline constexpr std::string_view free_flight = "free_flight";

std::vector<Case> free_flight_cases(const CommandLine& line, const Settings& settings);

Gloss free_flight_gloss();

/// Checks that backward Euler loses angular momentum, and that the midpoint rule
/// conserves that of particles.
void check_free_flight(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::validation
