#pragma once

#include <string_view>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::validation {

/// The rows `free_flight`: a hair thrown in space without gravity, spinning. No force
/// changes its momentum, its angular momentum or its energy, and no damping: what changes
/// them is the integrator. By every strand model whose root can be free and every
/// integrator; they say which, where the published tests have one of their own.
inline constexpr std::string_view free_flight = "free_flight";

std::vector<Case> free_flight_cases(const CommandLine& line, const Settings& settings);

Gloss free_flight_gloss();

/// That backward Euler loses angular momentum, and that the midpoint rule keeps that of
/// particles.
void check_free_flight(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::validation
