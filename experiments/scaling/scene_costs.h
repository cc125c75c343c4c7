#pragma once

#include <string>
#include <vector>

#include "experiments/run/experiment.h"

namespace tress::experiments::scaling {

/// Rows about scene files: what a semi-implicit step costs by every strand model that the
/// user leaves in, against the number of elements (of one typical strand; of all, where
/// they touch each other) and against the number of strands, cut as the file has them.
/// Throws InputError on scenes without strands and on two of one name.
std::vector<Case> scene_costs(const CommandLine& line,
                              const std::vector<std::string>& files);

}  // namespace tress::experiments::scaling
