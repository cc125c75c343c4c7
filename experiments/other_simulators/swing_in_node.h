#pragma once

#include <string_view>

#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {

/// Runs the strand in an engine that is an npm package: a process of node runs `script`
/// with `first_line` on its standard input. From then on a line of numbers makes it take
/// steps: the gravity of every step (mm/s^2, x y z, `phase` of a step after its start).
/// It answers with a line: wall time (s), the tip seen from the clamp (mm) and the
/// kinetic energy. An engine that gave up answers nan for the tip. Throws
/// std::runtime_error where the process ends.
std::unique_ptr<Simulator> swing_in_node(std::string_view script,
                                         std::string_view first_line, double dt,
                                         double phase);

}  // namespace tress::experiments::other_simulators
