#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// A strand whose weight dominates its stiffness, held at both ends.
std::vector<ValidationTest> hanging_tests();

}  // namespace tress::experiments::validation
