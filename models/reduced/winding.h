#pragma once

#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Returns the largest angle (rad) by which a segment winds, naturally or at the start.
/// `linear`: curvature varies along a segment.
double largest_winding(const Strand& strand, bool linear);
/// Returns the number of points of a segment that winds by `angle`: quadrature_points()
/// or clothoid_points(), and a pack of a rigid link.
int points_of_segment(Unknown unknown, double angle);

}  // namespace tress::models
