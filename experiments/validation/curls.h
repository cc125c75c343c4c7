#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// Strands with a natural curvature or twist.
std::vector<ValidationTest> curl_tests();

}  // namespace tress::experiments::validation
