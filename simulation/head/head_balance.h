#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simulation/head/head_run.h"

namespace tress::simulation {

/// Returns the cost of each strand of the batch, if the ranks took these times for
/// theirs.
std::vector<double> cost_of_strands(const HeadDivision& division,
                                    std::span<const double> seconds);

/// Divides the strands again, by all ranks, and returns the new run. Null unless the time
/// lost since the last call exceeds `anew_s` (s), the time of a new division. The time
/// lost is that of the slowest rank's steps beyond the mean. Strands are sent `at_once`
/// at a time.
std::unique_ptr<HeadRun> balanced(HeadRun& run, const SceneOutline& outline,
                                  const HeadPack& pack, int threads, double anew_s,
                                  std::size_t at_once);

}  // namespace tress::simulation
