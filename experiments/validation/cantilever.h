#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// A clamped strand bent by its weight or by a tip force.
std::vector<ValidationTest> cantilever_tests();

}  // namespace tress::experiments::validation
