#pragma once

#include "math/frame.h"

namespace tress::simulation {

/// x without its part along the unit vector `axis`, normalised; 0 if less than 1e-9 of x
/// is left.
Vec across(const Vec& axis, const Vec& x);

/// The frame with unit tangent e0 and e1 nearest to `normal`, which must be across() it
/// and not 0.
Frame frame_of(const Vec& tangent, const Vec& normal);

/// The frame with tangent `next`, `step` (m) further along a curve, without twist: e1 is
/// reflected twice [Wang, Juttler, Zheng & Liu 2008].
Frame carried(const Frame& frame, const Vec& step, const Vec& next);

/// The rotation vector from frame f to g (rad), in components of either.
Vec rotation_between(const Frame& f, const Frame& g);

}  // namespace tress::simulation
