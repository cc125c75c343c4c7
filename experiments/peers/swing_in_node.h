#pragma once

#include <string_view>

#include "experiments/peers/peer.h"

namespace tress::experiments::peers {

/// The strand in an engine that is an npm package: a process of node runs `script` with
/// `first_line` on its standard input. From then on a line of numbers, the gravity of
/// every step (mm/s^2, x y z, `phase` of a step after its start), makes it take those
/// steps, and it answers with a line: wall time (s), the tip seen from the clamp (mm) and
/// the kinetic energy. An engine that gave up answers nan for the tip. Throws
/// std::runtime_error where the process ends.
std::unique_ptr<Peer> swing_in_node(std::string_view script, std::string_view first_line,
                                    double dt, double phase);

}  // namespace tress::experiments::peers
