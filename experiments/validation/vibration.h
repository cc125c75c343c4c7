#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress {

/// Frequencies of small free vibrations about a state of rest.
std::vector<ValidationTest> vibration_tests();

}  // namespace tress
