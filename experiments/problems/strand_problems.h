#pragma once

#include <span>

#include "experiments/problems/problems.h"

namespace tress {

/// A hair let go horizontally (scene `release`), 10 cm long, seen at its tip for the
/// quarter of a second of its fall:
///
/// strand_release, time: super_helix of 10 elements by every integrator, some of them on
///   each solver of the model.
/// strand_release, total: every strand model of 3 to 40 elements against the continuous
///   rod (converged_rod).
///
/// Bending alone: nothing twists the strand, and explicit methods take part. Made once,
/// at the first call, which takes some seconds.
std::span<const Problem> strand_problems();

}  // namespace tress
