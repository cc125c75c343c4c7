#pragma once

#include <string_view>

#include "contract/layers.h"
#include "math/frame.h"
#include "simulation/scene/table.h"

namespace tress::simulation {

/// The vector of `key`, normalised. Throws InputError with its location when it is 0.
Vec direction(const Table& table, std::string_view key);

/// x without its part along the unit vector `axis`, normalised; 0 if less than 1e-9 of x
/// is left.
Vec across(const Vec& axis, const Vec& x);

/// The frame with unit tangent e0 and e1 nearest to `normal`, which must be across() it
/// and not 0.
Frame frame_of(const Vec& tangent, const Vec& normal);

}  // namespace tress::simulation
