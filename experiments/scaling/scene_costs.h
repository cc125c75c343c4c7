#pragma once

#include <string>
#include <vector>

#include "experiments/run/experiment.h"

namespace tress::experiments::scaling {

/// Rows for scene files: the cost of a semi-implicit step by every selected strand model,
/// against the number of elements (of one typical strand; of all, where they touch each
/// other) and against the number of strands with the file's discretisation. Throws
/// InputError on scenes without strands and on two of one name.
std::vector<Case> scene_costs(const CommandLine& line,
                              const std::vector<std::string>& files);

}  // namespace tress::experiments::scaling
