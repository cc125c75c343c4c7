#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// Loads at which a straight or circular equilibrium loses stability: where the least
/// omega^2 of small motions about it crosses 0.
std::vector<ValidationTest> buckling_tests();

}  // namespace tress::experiments::validation
