#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simulation/head/head_run.h"

namespace tress::simulation {

/// Of each strand of the head, if the ranks took these times for theirs.
std::vector<double> cost_of_strands(const HeadDivision& division,
                                    std::span<const double> seconds);

/// By all ranks: the strands divided anew, if what the slowest rank has taken longer for
/// its steps than the mean, since this was last asked, is more than the `anew_s` (s) that
/// to make them takes; else null. They come from their ranks so many at a time.
std::unique_ptr<HeadRun> balanced(HeadRun& run, const SceneOutline& outline,
                                  const HeadPack& pack, int threads, double anew_s,
                                  std::size_t at_once);

}  // namespace tress::simulation
