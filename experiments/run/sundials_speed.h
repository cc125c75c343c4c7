#pragma once

#include "contract/layers.h"

namespace tress::experiments {

/// Above it SUNDIALS was built without optimisation, as some distributions ship it, and
/// comparisons with our own methods mean nothing.
constexpr double slow_sundials_ratio = 4;

/// Time of N_VLinearSum over that of the same loop compiled here, on vectors that stay in
/// the first-level cache. About 1 for a Release build. Takes a few milliseconds.
double sundials_speed_ratio();

}  // namespace tress::experiments
