#pragma once

#include "contract/layers.h"

namespace tress::experiments {

/// Above this ratio SUNDIALS was built without optimisation, as some distributions ship
/// it, and timing comparisons with our own methods are meaningless.
constexpr double slow_sundials_ratio = 4;

/// Time of N_VLinearSum over that of the same loop compiled here, on vectors that fit in
/// the L1 cache. About 1 for a Release build. Takes a few milliseconds.
double sundials_speed_ratio();

}  // namespace tress::experiments
