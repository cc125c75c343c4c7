#pragma once

#include <cmath>

#include "simulation/run/method_dissipation.h"

namespace tress::simulation {

/// Whether a run warns of the energy that its method dissipated or created: more than a
/// tenth of that of the motion. Energy is as the square of an amplitude: less than this
/// changes that by less than a twentieth.
inline bool warns(const MethodDissipation& of) { return std::abs(of.share()) > 0.1; }

}  // namespace tress::simulation
