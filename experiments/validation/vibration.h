#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// Frequencies of small free vibrations about an equilibrium.
std::vector<ValidationTest> vibration_tests();

}  // namespace tress::experiments::validation
