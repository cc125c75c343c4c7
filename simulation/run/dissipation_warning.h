#pragma once

#include "simulation/run/method_dissipation.h"

namespace tress::simulation {

/// Whether a run warns of the energy that its method dissipated or created: the account
/// proves more than a tenth of that of the motion. Energy is as the square of an
/// amplitude: less than this changes that by less than a twentieth. A strand that moves
/// by less than a thousandth of its length is at rest, and has no motion to change.
inline bool warns(const MethodDissipation& of) {
  return of.moved > 1e-3 && of.proven() > 0.1 * of.available;
}

}  // namespace tress::simulation
