#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// The buckling of a wisp held between two approaching hands: a clamped strand whose tip
/// is held in place, free to turn, while the clamp goes down by eps L. First it bends,
/// under Euler's load P = 20.19 EI/L^2 for one clamped and one pinned end, then it coils
/// up.
///
/// wisp_bends: P from the work of the clamp, the change of the potential energy from 0.8
///   to 1.2 eps L, against the elastica's P(eps).
///
/// wisp_coils: the turns of the tip, against the plane elastica. The test begins in the
///   plane and nothing leads out of it.
std::vector<ValidationTest> wisp_tests();

}  // namespace tress::experiments::validation
