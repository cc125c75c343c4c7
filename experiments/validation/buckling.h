#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// Loads at which a straight or circular equilibrium stops being stable: where the least
/// omega^2 of small motions about it passes 0.
std::vector<ValidationTest> buckling_tests();

}  // namespace tress::experiments::validation
