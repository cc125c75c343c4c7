#pragma once

#include <cstddef>
#include <vector>

#include "experiments/simulate/scene_run.h"
#include "simulation/export/head_frames.h"

namespace tress::experiments::scene_runs {

/// Returns the strands that pictures of a head of `strands` strands show, 1000 at most.
/// These are every k-th strand, so that the roots of a groom are Fibonacci's lattice
/// again.
std::vector<std::size_t> shown_strands(std::size_t strands);

/// Returns the number of frames that pictures of a head of `frames` frames show, 50 at
/// most.
std::size_t shown_frames(std::size_t frames);

/// Writes pictures of the shown strands and frames in the format of any scene. All frames
/// of all strands would not fit into memory, or on a page.
void write_head_pictures(const SceneOutline& outline, const HeadFrames& frames,
                         const std::vector<std::size_t>& shown,
                         const SceneRunOptions& options);

}  // namespace tress::experiments::scene_runs
